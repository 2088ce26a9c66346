"""Laws over many cases. A law is one test, not hundreds, and lists the cases that break it."""

from collections.abc import Callable, Iterable, Sequence
from inspect import Signature, signature
from itertools import islice
from typing import Any


def over(cases: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Runs a check with each case, a tuple of its first arguments or the only one; its others are fixtures.

    Of cases that are found as they are asked for, all but the first wait for the test."""
    found = iter(cases)
    every = [_arguments(case) for case in islice(found, 1)]

    def law(check: Callable[..., None]) -> Callable[..., None]:
        def test(**fixtures: Any) -> None:
            every.extend(map(_arguments, found))
            hold(every, lambda *case: check(*case, **fixtures))

        fixtures = list(signature(check).parameters.values())[len(every[0]) if every else 0 :]
        test.__signature__ = Signature(fixtures)  # type: ignore[attr-defined]
        test.__name__, test.__doc__, test.__module__ = check.__name__, check.__doc__, check.__module__
        return test

    return law


def _arguments(case: Any) -> tuple[Any, ...]:
    return case if isinstance(case, tuple) else (case,)


def hold(cases: Sequence[tuple[Any, ...]], check: Callable[..., None]) -> None:
    """Runs a check with each case, and lists those that break it."""
    assert cases, "no cases"
    broken: list[Exception] = []
    for case in cases:
        try:
            check(*case)
        except Exception as error:
            names = (getattr(part, "id", None) or getattr(part, "__name__", None) or part for part in case)
            error.add_note(f"for {', '.join(str(name)[:80] for name in names)}")
            broken.append(error)
    if broken:
        raise ExceptionGroup(f"{len(broken)} of {len(cases)} cases", broken)
