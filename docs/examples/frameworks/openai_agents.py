"""pip install openai-agents; python openai_agents.py MODEL"""

import asyncio
import sys

from agents.mcp import MCPServerStdio

from agents import Agent, Runner, set_default_openai_api

set_default_openai_api("chat_completions")  # which servers of your own speak too: OPENAI_BASE_URL
CAR = {"command": "automotive-cosim", "args": ["mcp", "--interface", "functions"]}
WISH = "Start the task hvac_fan_max in scenario grid with see nothing, do what the driver asks, then finish."


async def _drive():
    async with MCPServerStdio(params=CAR, client_session_timeout_seconds=300) as car:
        agent = Agent("assistant", model=sys.argv[1], mcp_servers=[car])
        print((await Runner.run(agent, WISH, max_turns=30)).final_output)


asyncio.run(_drive())
