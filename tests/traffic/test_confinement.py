"""A confined process can write to its folder only."""

import socket
import subprocess
import sys
from pathlib import Path

import pytest

from automotive_cosim.traffic.confinement import confined, version

pytestmark = pytest.mark.skipif(not version(), reason="this kernel has no Landlock")

PROGRAM = """
import os, socket, sys
inside, outside, port = sys.argv[1:]
attempts = {
    "write inside": lambda: open(inside + "/new", "w").write("x"),
    "remove inside": lambda: os.remove(inside + "/new"),
    "write to nothing": lambda: open(os.devnull, "w").write("x"),
    "read outside": lambda: open(outside + "/old").read(),
    "write outside": lambda: open(outside + "/new", "w"),
    "append outside": lambda: open(outside + "/old", "a"),
    "truncate outside": lambda: os.truncate(outside + "/old", 0),
    "remove outside": lambda: os.remove(outside + "/old"),
    "move out": lambda: os.rename(inside + "/own", outside + "/moved"),
    "make a folder outside": lambda: os.mkdir(outside + "/folder"),
    "link outside": lambda: os.symlink("x", outside + "/link"),
    "through a link": lambda: open(inside + "/way/new", "w"),
    "connect": lambda: socket.create_connection(("127.0.0.1", int(port))),
}
for name, attempt in attempts.items():
    try:
        attempt()
        print(name)
    except OSError:
        pass
"""


def test_it_writes_to_its_folder_and_nowhere_else(tmp_path: Path) -> None:
    inside, outside = tmp_path / "inside", tmp_path / "outside"
    for folder in (inside, outside):
        folder.mkdir()
    (outside / "old").write_text("x")
    (inside / "own").write_text("x")
    (inside / "way").symlink_to(outside)
    with socket.create_server(("127.0.0.1", 0)) as server:
        arguments = [str(inside), str(outside), str(server.getsockname()[1])]
        command = confined(inside, [sys.executable, "-c", PROGRAM, *arguments])
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    allowed = {"write inside", "remove inside", "write to nothing", "read outside"}
    assert set(done.stdout.splitlines()) - ({"connect"} if version() < 4 else set()) == allowed
    assert [path.name for path in outside.iterdir()] == ["old"]
    assert (outside / "old").read_text() == "x"
