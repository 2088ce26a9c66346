"""There is one way to write: whole, through no link of somebody else's, and one writer at a time."""

import ast
import errno
import os
import re
import resource
import signal
from contextlib import contextmanager
from pathlib import Path

import pytest

from automotive_cosim.errors import UserError
from automotive_cosim.formats.writing import (
    add_line,
    appearing,
    beneath,
    copy,
    drafted,
    growing,
    is_being_written,
    locked,
    make_folder,
    write_whole,
)
from tests.laws import over

TOP = Path(__file__).parents[2]
EVERYWHERE = {
    "write_text", "write_bytes", "mkdir", "makedirs", "copytree", "copyfile", "copymode", "copystat", "copy2",
    "rename", "renames", "symlink_to", "hardlink_to", "rmtree", "rmdir", "removedirs", "unlink", "mkstemp",
    "NamedTemporaryFile", "extractall", "chmod", "mkfifo", "mknod", "flock", "lockf",
}  # fmt: skip
"""Calls that write, whatever they are asked of."""
OF_MODULES = {
    "os": {"link", "symlink", "remove", "replace", "truncate", "open"},
    "shutil": {"copy", "move", "unpack_archive", "make_archive"},
}
TO_FILES = {"save": 0, "savefig": 0, "to_parquet": 0, "write_table": 1, "ZipFile": 0}
"""Calls of libraries that take a file in place of a path, and which argument that is."""
FILES = {"file", "data", "content"}
"""What open files and memory are called."""
EXCEPTIONS = {
    "automotive_cosim/formats/writing.py": "it is the one way",
    "automotive_cosim/cli/terminal.py": "opens this program's own streams again",
    "automotive_cosim/safety/protocol/calculate.py": "a program for another Python, in a scratch folder",
    "automotive_cosim/traffic/process.py": "hands a fork its own copy, in a scratch folder, of what SUMO writes",
    "automotive_cosim/traffic/remote.py": "locks a file without a name, to take turns with its copies",
    "agents/process.py": "tells the kernel which process is to end first",
    "agents/cleanup.py": "empties what an agent left, deeper than paths are long",
    "automotive_cosim/osm/extract.py": "a link in a scratch folder, by whose name a library knows a format",
}
SOURCES = [
    path for folder in ("automotive_cosim", "agents", "tasks") for path in sorted((TOP / folder).rglob("*.py"))
]


def writes(call):
    """Whether a call writes by itself."""
    function, given = call.func, call.args
    options = {each.arg: ast.unparse(each.value) for each in call.keywords}
    name = function.attr if isinstance(function, ast.Attribute) else getattr(function, "id", "")
    of = ast.unparse(function.value) if isinstance(function, ast.Attribute) else ""
    mode = (
        ast.unparse(given[of == "" or of == "os"]) if len(given) > (of in ("", "os")) else options.get("mode", "")
    )
    if name in TO_FILES:
        at = TO_FILES[name]
        is_other = of == "super()" or (name == "ZipFile" and len(given) < 2)
        return not is_other and len(given) > at and getattr(given[at], "id", "") not in FILES
    if name in ("TemporaryDirectory", "mkdtemp"):
        return "dir" in options
    if name == "open" and of != "os":
        return of != "archive" and bool(re.fullmatch(r"'[^']*[wax+][^']*'", mode))
    if name == "open":
        writing = any(flag in mode for flag in ("WRONLY", "RDWR", "CREAT", "APPEND", "TRUNC"))
        return writing and ast.unparse(given[0]) != "os.devnull"
    if name == "replace" and of != "os":
        return bool(of) and len(given) == 1 and not options
    if name == "touch":
        return not given
    if name == "write":
        return "ElementTree(" in of
    return name in EVERYWHERE or name in OF_MODULES.get(of, ())


@over([path for path in SOURCES if path.relative_to(TOP).as_posix() not in EXCEPTIONS])
def test_nothing_is_written_but_by_the_one_module(path):
    calls = [each for each in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(each, ast.Call)]
    found = [f"line {each.lineno}: {ast.unparse(each)[:80]}" for each in calls if writes(each)]
    assert not found, f"{path}: {found}"


def test_every_exception_is_needed():
    for name in EXCEPTIONS:
        tree = ast.parse((TOP / name).read_text(encoding="utf-8"))
        assert any(isinstance(each, ast.Call) and writes(each) for each in ast.walk(tree)), name


WRITING = """
open(p, "w"); open(p, mode="ab"); p.open("x"); p.open("r+"); os.open(p, os.O_WRONLY | os.O_NOFOLLOW); p.unlink()
p.replace(q); os.replace(a, b); p.touch(); p.write_text(t); shutil.copy(a, b); copytree(a, b); shutil.move(a, b)
ET.ElementTree(root).write(target); picture.save(path); picture.save(f"{a}.png"); frame.to_parquet(target)
ZipFile(out, "w"); TemporaryDirectory(dir=here); folder.mkdir(); fcntl.flock(f, 1)"""
READING = """
open(p); open(p, "rb"); p.open(); p.open(mode="r"); os.open(p, os.O_RDONLY); text.replace("a", "b"); ZipFile(path)
replace(row, error=None); now.replace(hour=1); self.touch(action); copy(a, b, 9); x.copy(); file.write(text)
picture.save(file, "PNG"); TemporaryDirectory(prefix="x"); scenario.move(there); remove(path)"""


@over([(text is WRITING, line) for text in (WRITING, READING) for line in re.split(r"; |\n", text.strip())])
def test_the_law_knows_what_writes(is_so, line):
    calls = [each for each in ast.walk(ast.parse(line)) if isinstance(each, ast.Call)]
    assert any(map(writes, calls)) == is_so, line


@pytest.fixture
def elsewhere(tmp_path):
    """A file and a folder of somebody's, to which links in ``results`` lead."""
    outside, results = tmp_path / "outside", tmp_path / "results"
    outside.mkdir()
    results.mkdir()
    (outside / "diary.txt").write_text("private")
    (results / "tables").symlink_to(outside)
    for name in ("page.html", "log.jsonl", "lock", ".page.html.lock"):
        (results / name).symlink_to(outside / "diary.txt")
    yield results
    assert {path.name: path.read_text() for path in outside.iterdir()} == {"diary.txt": "private"}


REFUSED = {
    "a folder": lambda results: make_folder(results, "tables"),
    "a folder in it": lambda results: make_folder(results, "tables/deep"),
    "a file in it": lambda results: beneath(results, "tables/diary.txt"),
    "a folder above": lambda results: beneath(results, "../outside"),
    "any folder": lambda results: beneath(results, "/tmp"),
    "a log": lambda results: growing(results / "log.jsonl"),
    "a lock": lambda results: locked(results / "lock", results).__enter__(),
    "the lock of a page": lambda results: write_whole(results / "page.html", "x"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_nothing_is_written_through_a_link_in_a_folder(elsewhere, what):
    with pytest.raises(UserError, match="is a link, and nothing here goes through one") as refused:
        REFUSED[what](elsewhere)
    assert "\n" not in str(refused.value)


def test_a_whole_file_and_a_log_begun_anew_take_the_place_of_a_link(elsewhere):
    (elsewhere / ".page.html.lock").unlink()
    write_whole(elsewhere / "page.html", "x")
    growing(elsewhere / "log.jsonl", anew=True).close()
    assert not (elsewhere / "page.html").is_symlink()
    assert not (elsewhere / "log.jsonl").is_symlink()
    assert (elsewhere / "page.html").read_text() == "x"


def test_the_folder_that_a_user_names_may_be_a_link(tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "runs").symlink_to(tmp_path / "disk")
    write_whole(make_folder(tmp_path / "runs", "a/b") / "x", "x")
    assert (tmp_path / "disk/a/b/x").read_text() == "x"


@pytest.fixture(params=["without a name", "with a name"])
def drafts(request, monkeypatch):
    """Drafts as this file system has them, and as one without unnamed files does."""
    if request.param == "with a name":
        monkeypatch.setattr(os, "O_TMPFILE", os.O_DIRECTORY | os.O_CREAT)  # which no system takes
    return request.param


@pytest.mark.usefixtures("drafts")
def test_what_fails_leaves_what_was_there_and_nothing_else(tmp_path, monkeypatch):
    path = tmp_path / "x"
    write_whole(path, "before")
    with pytest.raises(ZeroDivisionError), drafted(path) as file:
        file.write(bytes(1 // 0))
    with pytest.raises(OSError, match=re.escape(str(path))) as full, drafted(path):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert full.value.errno == errno.ENOSPC
    monkeypatch.setattr(os, "replace", lambda *_, **__: Path("/none").stat())
    with pytest.raises(FileNotFoundError):
        write_whole(path, "after")
    assert [each.name for each in tmp_path.iterdir()] == ["x"]
    assert path.read_text() == "before"
    assert path.stat().st_mode & 0o777 == 0o666 & ~_umask()


def _umask():
    os.umask(before := os.umask(0))
    return before


@contextmanager
def child():
    """A process of our own that ends with the block, killed."""
    pid = os.fork()
    if pid:
        _, status = os.waitpid(pid, 0)
        assert os.WIFSIGNALED(status)
        assert os.WTERMSIG(status) == signal.SIGKILL
        yield False
    else:
        try:
            yield True
        finally:
            os.kill(os.getpid(), signal.SIGKILL)


def test_a_kill_leaves_the_file_that_was_there_and_no_draft(tmp_path):
    write_whole(tmp_path / "x", "before")
    with child() as is_child:
        if is_child:
            with drafted(tmp_path / "x") as file, locked(tmp_path / "lock", "x"):
                file.write(b"half")
                os.kill(os.getpid(), signal.SIGKILL)
    assert {each.name for each in tmp_path.iterdir()} == {"x", "lock", ".x.lock"}
    assert (tmp_path / "x").read_text() == "before"
    with locked(tmp_path / "lock", "x"):
        write_whole(tmp_path / "x", "after")
    assert {each.name for each in tmp_path.iterdir()} == {"x"}


TWICE = {
    "file": (drafted, lambda path: write_whole(path, "second")),
    "log": (growing, lambda path: growing(path).close()),
    "log, anew": (lambda path: growing(path, anew=True), lambda path: growing(path, anew=True).close()),
    "lock": (lambda path: locked(path, path), lambda path: locked(path, path).__enter__()),
}


@pytest.mark.parametrize("kind", TWICE)
def test_of_two_writers_one_is_refused(tmp_path, kind):
    path, (first, second) = tmp_path / "x", TWICE[kind]
    with first(path) as file:
        if kind == "file":
            file.write(b"first")
        with pytest.raises(UserError, match=re.escape(f"another program is writing {path}; wait")):
            second(path)
        assert is_being_written(path) == (kind != "file")
    if kind == "file":
        assert path.read_text() == "first"
    if kind != "lock":
        second(path)
    assert [each.name for each in tmp_path.iterdir()] in ([], ["x"])


def test_a_log_is_mended_and_keeps_whole_lines(tmp_path):
    path = tmp_path / "log"
    for length in (0, 1, 2**16 - 1, 2**16, 3 * 2**16):
        path.write_bytes(b"whole\n" + b"x" * length)
        with growing(path) as file:
            add_line(file, "next", lasting=True)
        assert path.read_bytes() == b"whole\nnext\n"


def test_a_line_that_does_not_fit_is_not_there(tmp_path):
    path = tmp_path / "log"
    with growing(path) as file:
        add_line(file, "first")
        before, most = resource.getrlimit(resource.RLIMIT_FSIZE)
        handler = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (20, most))
        try:
            with pytest.raises(OSError, match="too large"):
                add_line(file, "x" * 30)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, (before, most))
            signal.signal(signal.SIGXFSZ, handler)
        assert path.read_text() == "first\n"
        add_line(file, "second")
    assert path.read_text() == "first\nsecond\n"


def test_a_copy_is_of_a_regular_file_and_bounded(tmp_path):
    (tmp_path / "x").write_bytes(b"12345")
    assert copy(tmp_path / "x", tmp_path / "y", 5) == 5
    with pytest.raises(UserError, match="too large"):
        copy(tmp_path / "x", tmp_path / "z", 4)
    with pytest.raises(OSError, match="not a regular file"):
        copy(Path("/dev/zero"), tmp_path / "z", 4)
    assert {each.name for each in tmp_path.iterdir()} == {"x", "y"}


def test_a_folder_appears_whole_or_not_at_all(tmp_path):
    out = tmp_path / "out"
    with pytest.raises(ZeroDivisionError), appearing(out) as folder:
        write_whole(folder / "x", str(1 // 0))
    assert not list(tmp_path.iterdir())
    with appearing(out) as folder:
        write_whole(folder / "x", "x")
    with pytest.raises(UserError, match="exists; give"), appearing(out) as folder:
        write_whole(folder / "y", "y")
    assert [each.name for each in out.iterdir()] == ["x"]
    with appearing(out, replaces=True) as folder:
        write_whole(folder / "y", "y")
    assert [each.name for each in out.iterdir()] == ["y"]
    with appearing(tmp_path / "empty"):
        pass
    assert [each.name for each in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("name", [".", "new", "new/a/b", "../.out.lock"])
def test_an_error_names_the_folder_that_was_asked_for_and_not_where_it_is_made(tmp_path, name):
    out = tmp_path / "out"
    asked = out / name.removeprefix("new/") if name.startswith("new/") else out

    def fails(error):
        with appearing(out) as folder:
            raise error(folder)

    with pytest.raises(OSError, match="full") as caught:
        fails(lambda folder: OSError(errno.ENOSPC, "full", os.path.normpath(folder.parent / name)))
    assert caught.value.filename == str(asked)
    with pytest.raises(UserError, match=re.escape(f"{out}/a line 3")):
        fails(lambda folder: UserError(f"{folder}/a line 3: no"))
    with pytest.raises(OSError, match="full") as other:
        fails(lambda _: OSError(errno.ENOSPC, "full", "elsewhere"))
    assert other.value.filename == "elsewhere"


def test_what_a_killed_program_has_left_of_a_folder_is_removed_by_the_next_and_two_do_not_make_it_at_once(tmp_path):
    out, kept = tmp_path / "out", tmp_path / f".other-{16 * '0'}"
    kept.mkdir()
    for name in ("new", "replaced"):
        make_folder(tmp_path, f".out-{16 * 'a'}/{name}")
        write_whole(tmp_path / f".out-{16 * 'a'}" / name / "x", name)
    with appearing(out, replaces=True):
        assert (out / "x").read_text() == "replaced"  # the kill came before the new one had taken its place
        with pytest.raises(UserError, match="another program is writing"), appearing(out, replaces=True):
            pass
    assert {each.name for each in tmp_path.iterdir()} == {"out", kept.name}
