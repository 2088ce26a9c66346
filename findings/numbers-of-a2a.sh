#!/bin/bash
# Seen with a2a-sdk 1.3.0 (protocol 1.0): whole numbers in a data part become floating ones, for they are google.protobuf
# values. Who sends {"seats": 3} is read as 3.0, in the message and on the wire, which code that asks for an int
# refuses; and a number from 2**53 on, as of an order, is another one. Nothing is said. With a text part of JSON
# both stay. One would expect JSON to go through as it is.
# Seen (what arrives of {"seats": 3, "order": 9007199254740993}; whether the order is the one that was sent):
#   data part: {"seats": 3.0, "order": 9007199254740992.0}; False
#   text part: {"seats": 3, "order": 9007199254740993}; True
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q a2a-sdk==1.3.0
cat > seen.py << 'P'
import json

from a2a.helpers.proto_helpers import new_data_part, new_message, new_text_part
from a2a.types import Message
from google.protobuf.json_format import MessageToDict, MessageToJson, Parse

sent = {"seats": 3, "order": 9007199254740993}
wire = MessageToJson(new_message([new_data_part(sent), new_text_part(json.dumps(sent))]))
data, text = Parse(wire, Message()).parts
for name, got in ("data part", MessageToDict(data.data)), ("text part", json.loads(text.text)):
    print(f"{name}: {json.dumps({key: got[key] for key in sent})}; {got['order'] == sent['order']}")
P
v/bin/python seen.py | tee seen.txt
diff - seen.txt << END
data part: {"seats": 3.0, "order": 9007199254740992.0}; False
text part: {"seats": 3, "order": 9007199254740993}; True
END
