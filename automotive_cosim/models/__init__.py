"""Models for the agents: one chat protocol, several back ends.

``rules``               a deterministic stand-in that reads the prompt by keywords; runs anywhere
``replay/FOLDER``       the answers recorded in an episode's folder, for an exact re-run
``replay/NAME``         those of a shipped conversation (``automotive_cosim/replay``)
``local``               a small model in this process, from an installed package; see ``local``
``local/FILE.gguf``     a model in this process, from a file
``openai/NAME``         OpenAI, or the server that ``OPENAI_BASE_URL`` names
``PROVIDER/NAME``       any OpenAI-compatible endpoint: ``PROVIDER_API_KEY`` and ``PROVIDER_BASE_URL``

The last four take settings, as in ``openai/NAME?seed=3&timeout_s=30``; see ``remote.Settings`` and
``local.LocalSettings``.
"""

from __future__ import annotations

from automotive_cosim.lazy import lazily

__getattr__, __dir__ = lazily(__name__, __file__)
