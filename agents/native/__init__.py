"""Models that have learnt to operate screens, in the format that each was trained on. They see the picture alone.

grid      a format's coordinates and the screen's pixels
verbs     what a format's words mean as actions, and back
syntax    a format's texts, and the calls in them
formats   the table of formats
agent     the agent ``native``

    text  <- syntax ->  GuiCall(name, arguments)  <- verbs, grid ->  Action
"""

from automotive_cosim.agents.native.agent import NativeAgent
from automotive_cosim.agents.native.formats import FORMATS, Format, chosen

__all__ = ["FORMATS", "Format", "NativeAgent", "chosen"]
