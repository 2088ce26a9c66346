"""pip install 'smolagents[mcp,openai]'; python smolagents_car.py MODEL"""

import sys

from mcp import StdioServerParameters
from smolagents import OpenAIServerModel, ToolCallingAgent, ToolCollection

CAR = StdioServerParameters(command="automotive-cosim", args=["mcp", "--interface", "functions"])
WISH = "Start the task hvac_fan_max in scenario grid with see nothing, do what the driver asks, then finish."
with ToolCollection.from_mcp(CAR, trust_remote_code=True, structured_output=False) as car:
    print(ToolCallingAgent(tools=[*car.tools], model=OpenAIServerModel(sys.argv[1])).run(WISH))
