"""Laws over many cases. A law is one test, not hundreds, and lists the cases that break it."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any


def over(cases: Iterable[Any]) -> Callable[[Callable[..., None]], Callable[[], None]]:
    """Runs a check with each case, a tuple of its arguments or the only one."""
    every = [case if isinstance(case, tuple) else (case,) for case in cases]

    def law(check: Callable[..., None]) -> Callable[[], None]:
        def test() -> None:
            assert every, "no cases"
            broken: list[AssertionError] = []
            for case in every:
                try:
                    check(*case)
                except AssertionError as error:
                    error.add_note(f"for {', '.join(getattr(part, 'id', str(part)) for part in case)}")
                    broken.append(error)
            if broken:
                raise ExceptionGroup(f"{len(broken)} of {len(every)} cases", broken)

        test.__name__, test.__doc__, test.__module__ = check.__name__, check.__doc__, check.__module__
        return test

    return law
