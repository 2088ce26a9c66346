"""The names that are loaded at first use, and where each is defined (``lazy``)."""

from automotive_cosim.models.base import ChatMessage, ChatModel, ModelReply
from automotive_cosim.models.names import MODELS, make_model
from automotive_cosim.models.replay import Replay
from automotive_cosim.models.rules import Rules

__all__ = ["MODELS", "ChatMessage", "ChatModel", "ModelReply", "Replay", "Rules", "make_model"]
