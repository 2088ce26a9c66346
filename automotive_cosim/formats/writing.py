"""The one way to write: files whole or line by line, folders and copies, through no link that somebody else made.

A results folder or a scenario may be somebody else's, who put a link into it. The folder that a user names may be a
link; beneath it, ``make_folder`` goes through none, and no file is opened through one: a whole file takes a link's
place, a growing one and a lock refuse it.
"""

from __future__ import annotations

import errno
import fcntl
import os
import secrets
import shutil
import stat
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path, PurePosixPath
from typing import IO

from automotive_cosim.errors import UserError
from automotive_cosim.formats import bounds
from automotive_cosim.formats.files import is_whole, open_file
from automotive_cosim.formats.plain import plain

LOOK_S = 0.05
"""Longer than a page takes to see whether a file is locked."""
_NEW = os.O_CREAT | os.O_RDWR | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC


def make_folder(folder: Path, name: str = "") -> Path:
    """A folder, made if it is missing, its parents too.

    Args:
        folder: one that the user named, or that was made so; it may be a link.
        name: a folder beneath it, with ``/`` between its parts, which may not.

    Raises:
        UserError: a part of the name is a link.
        OSError: it cannot be made."""
    path = beneath(folder, name)
    path.mkdir(parents=True, exist_ok=True)
    return path


def beneath(folder: Path, name: str) -> Path:
    """The path of a name beneath a folder, as for ``make_folder``, which need not exist.

    Raises UserError: a part of the name is a link."""
    for part in PurePosixPath(name).parts:
        folder /= part
        if part in ("..", "/") or folder.is_symlink():
            raise _led_away(folder)
    return folder


@contextmanager
def drafted(path: Path) -> Iterator[IO[bytes]]:
    """A draft of a file, which takes its place at the end, so that the file is there completely or not at all.

    The draft has no name until then, so that a kill leaves nothing. Nobody else can draft the file meanwhile.

    Args:
        path: the file, in a folder as ``make_folder`` gives it.

    Raises:
        UserError: another program is drafting it.
        OSError: it cannot be written; the error names the file."""
    draft = f".{secrets.token_hex(8)}.part"
    try:
        home = os.open(path.parent, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            with locked(path.with_name(f".{path.name}.lock"), path), _unnamed(home, draft) as file:
                yield file
                file.flush()
                with suppress(FileExistsError):  # on a file system on which it has its name already
                    os.link(f"/proc/self/fd/{file.fileno()}", draft, dst_dir_fd=home)
                os.replace(draft, path.name, src_dir_fd=home, dst_dir_fd=home)
        finally:
            with suppress(OSError):
                os.unlink(draft, dir_fd=home)
            os.close(home)
    except OSError as error:
        if error.errno is None:
            raise
        raise OSError(error.errno, error.strerror, str(path)) from error


def _unnamed(home: int, name: str) -> IO[bytes]:
    """A new file in an open folder, without a name if its file system has such files."""
    try:
        return os.fdopen(os.open(".", os.O_TMPFILE | os.O_RDWR | os.O_CLOEXEC, 0o666, dir_fd=home), "w+b")
    except OSError:
        return os.fdopen(os.open(name, _NEW | os.O_EXCL, 0o666, dir_fd=home), "w+b")


def write_whole(path: Path, content: str | bytes) -> None:
    """Writes a file, a text as plain text, as ``drafted`` does."""
    with drafted(path) as file:
        file.write(content if isinstance(content, bytes) else plain(content).encode())


@contextmanager
def locked(path: Path, what: object) -> Iterator[None]:
    """Holds a lock, a file that is removed again; the system releases it however this process ends.

    Args:
        what: what is written meanwhile, for errors.

    Raises:
        UserError: another program holds it, or it is a link.
        OSError: it cannot be made."""
    with _alone(path, what):
        try:
            yield
        finally:
            with suppress(OSError):
                path.unlink()


def growing(path: Path, *, anew: bool = False) -> FileIO:
    """A file that grows line by line, open at its end, and locked until it is closed.

    A last line that a kill cut short is removed.

    Args:
        path: the file, in a folder as ``make_folder`` gives it.
        anew: begin a new one in the place of what is there.

    Raises:
        UserError: another program is writing it, or it is a link.
        OSError: it cannot be opened."""
    if anew and not is_being_written(path):
        remove(path)
    file = _alone(path, path)
    size = file.seek(0, os.SEEK_END)
    begin = max(0, size - bounds.LINE_BYTES)
    whole = begin + os.pread(file.fileno(), size - begin, begin).rfind(b"\n") + 1
    if whole < size and is_whole(os.pread(file.fileno(), size - whole, whole)):
        file.write(b"\n")
    elif whole < size:
        file.truncate(whole)
    return file


def add_line(file: FileIO, line: str, *, lasting: bool = False) -> None:
    """Adds a line to a growing file, whole or not at all; one that is whole stays if only the wait is interrupted.

    Args:
        file: of ``growing``.
        line: without its end.
        lasting: wait until it is on the disk.

    Raises OSError: it cannot be written, e.g. because the disk is full; earlier lines are kept."""
    whole = file.seek(0, os.SEEK_END)
    left = line.encode() + b"\n"
    try:
        while left:
            left = left[file.write(left) :]
        if lasting:
            os.fsync(file.fileno())
    except BaseException as error:
        if left or isinstance(error, OSError):
            file.truncate(whole)
        raise


def is_being_written(path: Path) -> bool:
    """Whether a running program has locked that file; the system knows, however the program ends."""
    try:
        with open_file(path) as file:
            fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    except OSError:
        return False
    return False


def mark_as_written(file: IO[bytes]) -> None:
    """Locks a file until it is closed or the program ends, unless somebody else has."""
    with suppress(OSError):
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)


def remove(path: Path) -> None:
    """Removes a file, a link, or a folder with all that is in it; nothing where there is none.

    Raises OSError: it cannot be removed."""
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path)
    else:
        path.unlink(missing_ok=True)


def copy(source: Path, target: Path, most_bytes: int) -> int:
    """Copies the content of a regular file, completely or not at all; returns its size in bytes.

    Raises:
        UserError: it is larger.
        OSError: it cannot be read, is no regular file, or cannot be written."""
    size = 0
    with open_file(source) as given, drafted(target) as file:
        while piece := given.read(bounds.CHUNK_BYTES):
            size += len(piece)
            if size > most_bytes:
                raise UserError(f"{source} is too large to be copied: more than {most_bytes / 1e6:.0f} MB are left")
            file.write(piece)
    return size


@contextmanager
def appearing(out: Path, *, replaces: bool = False) -> Iterator[Path]:
    """An empty folder that becomes ``out`` if the block succeeds and fills it; otherwise nothing is left.

    Nobody else can make that folder meanwhile. What a killed program has left of it is removed.

    Args:
        out: where it goes, in a folder that is there.
        replaces: in the place of what is there.

    Raises:
        UserError: another program is making it, or there is something else by then.
        OSError: it cannot be written.
        Errors of the block and these name the folder, or what would be in it, where it was being made."""
    # Named before it is made, so that a signal between the two leaves nothing.
    home = out.absolute().parent
    scratch = home / f".{out.name}-{secrets.token_hex(8)}"
    building, replaced = scratch / "new", scratch / "replaced"
    lock = home / f".{out.name}.lock"
    try:
        with locked(lock, out):
            try:
                _clear(home, out)
                scratch.mkdir(mode=0o700)
                building.mkdir()
                yield building
                if any(building.iterdir()):
                    _exchange(building, out, replaced if replaces else None)
            finally:
                try:
                    shutil.rmtree(scratch, ignore_errors=True)
                finally:  # where a signal interrupted that
                    shutil.rmtree(scratch, ignore_errors=True)
    except UserError as error:
        error.args = tuple(str(each).replace(str(building), str(out)) for each in error.args)
        raise
    except OSError as error:
        hidden = Path(os.fsdecode(error.filename)) if isinstance(error.filename, str | bytes) else home
        if error.errno is None or not (hidden == lock or hidden.is_relative_to(scratch)):
            raise
        inside = hidden.relative_to(building).parts if hidden.is_relative_to(building) else ()
        raise OSError(error.errno, error.strerror, str(out.joinpath(*inside))) from error


def _clear(home: Path, out: Path) -> None:
    """Removes what was left by programs that were killed while they made a folder; nobody else makes it now."""
    for left in home.glob(".*-" + 16 * "[0-9a-f]"):
        if left.name[1:-17] == out.name and not left.is_symlink():
            if (left / "replaced").is_dir() and not out.exists():
                (left / "replaced").rename(out)
            shutil.rmtree(left, ignore_errors=True)


def _exchange(building: Path, out: Path, replaced: Path | None) -> None:
    """Puts a folder in its place; what is there goes to ``replaced``, if that may be."""
    if replaced is not None and out.exists():
        out.rename(replaced)
    try:
        building.rename(out)
    except BaseException as error:
        if replaced is not None and replaced.exists():
            replaced.rename(out)
        if getattr(error, "errno", 0) in (errno.EEXIST, errno.ENOTEMPTY, errno.ENOTDIR):
            raise UserError(f"{out} exists; give --out another folder, or delete that one") from error
        raise


def check_writable(folder: Path) -> None:
    """Tries whether a folder takes anything, which its permissions do not tell. Raises OSError: it does not."""
    probe = folder / f".{secrets.token_hex(8)}.part"
    probe.mkdir()
    probe.rmdir()


def _led_away(path: Path) -> UserError:
    return UserError(f"{path} is a link, and nothing here goes through one; remove it, or name another folder")


def _alone(path: Path, what: object) -> FileIO:
    """A file that is no link and nothing but a file, made if it is missing, open at its end and locked."""
    begun_s = time.monotonic()
    while True:
        if path.is_symlink():
            raise _led_away(path)
        file = FileIO(os.open(path, _NEW | os.O_APPEND, 0o666), "ab")
        is_free = True
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            is_free = False
        except OSError:
            pass  # some file systems have no locks
        about = os.fstat(file.fileno())
        if not stat.S_ISREG(about.st_mode):
            file.close()
            raise OSError(f"{path} is not a regular file")
        if (
            is_free and path.exists() and os.path.samestat(path.lstat(), about)
        ):  # its last holder may have removed it
            return file
        file.close()
        if (
            not is_free and time.monotonic() > begun_s + LOOK_S
        ):  # a page may check at this instant whether it is locked
            raise UserError(f"another program is writing {what}; wait until it has ended, or name another")
        time.sleep(LOOK_S)
