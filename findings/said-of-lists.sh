#!/bin/bash
# Seen with mcp 2.3.0: what a tool returns comes twice, as structured content and as text for the model, and the texts of lists
# are others than of all else. A list is a text for each of its entries, so that ["a"] and "a" look alike, and an empty list
# is no text at all: to a model, a search that finds nothing has said nothing. A list within an object is JSON. One would
# expect the JSON of a list there too, as it is in the structured content.
# Seen (what is returned: the texts):
#   []: no text
#   ["a"]: a
#   ["a", "b"]: a | b
#   {"found": []}: {"found": []}
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q mcp==2.3.0
cat > seen.py << 'P'
import asyncio
import json
import logging

from mcp import Client
from mcp.server import MCPServer

logging.disable()
server = MCPServer("places")

@server.tool()
def search(wanted: int) -> list[str]:
    return ["a", "b"][:wanted]

@server.tool()
def found(wanted: int) -> dict[str, list[str]]:
    return {"found": ["a", "b"][:wanted]}

async def main():
    async with Client(server) as client:
        for name, wanted in ("search", 0), ("search", 1), ("search", 2), ("found", 0):
            answer = await client.call_tool(name, {"wanted": wanted})
            given = answer.structured_content if name == "found" else answer.structured_content["result"]
            texts = [" ".join(each.text.split()) for each in answer.content]
            print(f"{json.dumps(given)}: {' | '.join(texts).replace('{ ', '{').replace(' }', '}') or 'no text'}")

asyncio.run(main())
P
v/bin/python seen.py 2> said.txt | tee seen.txt
diff - seen.txt << END
[]: no text
["a"]: a
["a", "b"]: a | b
{"found": []}: {"found": []}
END
