"""pip install 'smolagents[mcp,openai]'; python smolagents_car.py MODEL"""

import os
import sys

from mcp import StdioServerParameters
from smolagents import OpenAIServerModel, ToolCallingAgent, ToolCollection

CAR = StdioServerParameters(
    command="automotive-cosim", args=["mcp", "--interface", "functions"], env=dict(os.environ)
)
WISH = "Start the task hvac_fan_max in scenario grid with see nothing, do what the driver asks, then finish."
with ToolCollection.from_mcp(CAR, trust_remote_code=True, structured_output=False) as car:
    for tool in car.tools:  # to smolagents, a parameter is required unless it is nullable
        tool.inputs = {name: {**schema, "nullable": True} for name, schema in tool.inputs.items()}
    print(ToolCallingAgent([*car.tools], OpenAIServerModel(sys.argv[1])).run(WISH))
