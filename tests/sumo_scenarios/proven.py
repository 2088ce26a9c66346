"""Which of the shipped scenarios are as they were when an hour of their traffic and all their trips were proven.

python -m tests.sumo_scenarios.proven            # says which are not
python -m tests.sumo_scenarios.proven beauce     # proves that one, and notes that it holds
python -m tests.sumo_scenarios.proven --all      # proves each, which takes minutes
"""

import json
import subprocess
import sys
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

from automotive_cosim import scenarios

RECORD = Path(__file__).with_name("proven.json")
PROOFS = (str(Path(__file__).parent), str(Path(__file__).parents[1] / "scenarios" / "test_check.py"))


def digest(name: str) -> str:
    """Of what SUMO and the cockpit read of a scenario, and of SUMO's version."""
    folder = scenarios.load(name).folder
    made = sha256(version("libsumo").encode())
    for file in sorted(folder.iterdir()):
        if file.suffix not in (".md", ".webp"):
            made.update(file.name.encode() + b"\0" + file.read_bytes())
    return made.hexdigest()


def record() -> dict[str, str]:
    """Each scenario's digest when it was proven."""
    known: dict[str, str] = json.loads(RECORD.read_text())
    return known


def changed() -> list[str]:
    """Scenarios that are not as they were proven."""
    known = record()
    return [name for name in scenarios.shipped() if known.get(name) != digest(name)]


def main(names: list[str]) -> int:
    for name in scenarios.shipped() if names == ["--all"] else names:
        before = digest(name)
        if code := subprocess.run(
            [sys.executable, "-m", "pytest", "--prove", "-q", "-k", name, *PROOFS]
        ).returncode:
            return code
        known = {each: known for each, known in record().items() if each in scenarios.shipped()}
        RECORD.write_text(json.dumps({**known, name: before}, indent=1, sort_keys=True) + "\n")
    if stale := changed():
        sys.stdout.write(f"to prove: {' '.join(stale)}\n")
    return bool(stale)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
