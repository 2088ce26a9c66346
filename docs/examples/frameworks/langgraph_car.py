"""pip install langgraph langchain-openai langchain-mcp-adapters; python langgraph_car.py MODEL"""

import asyncio
import sys

from langchain_mcp_adapters.client import MultiServerMCPClient
from langchain_mcp_adapters.tools import load_mcp_tools
from langchain_openai import ChatOpenAI
from langgraph.prebuilt import create_react_agent

CAR = {"transport": "stdio", "command": "automotive-cosim", "args": ["mcp", "--interface", "functions"]}
WISH = "Start the task hvac_fan_max in scenario grid with see nothing, do what the driver asks, then finish."


async def _drive():
    async with MultiServerMCPClient({"car": CAR}).session("car") as car:
        agent = create_react_agent(ChatOpenAI(model=sys.argv[1]), await load_mcp_tools(car))
        told = await agent.ainvoke({"messages": [("user", WISH)]}, {"recursion_limit": 60})
        print(told["messages"][-1].content)


asyncio.run(_drive())
