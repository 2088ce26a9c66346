"""What pages share."""

from __future__ import annotations

import re

from automotive_cosim.report.templates import render


def test_a_manifest_lists_what_was_given_and_no_none() -> None:
    plan = {
        "scale": None,
        "via": [],
        "step_s": 1.0,
        "redraw": False,
        "seeds": [0, 1],
        "limits": {"a": 2, "b": None},
    }
    page = render(
        "studies/network.html", title="", about="", answer="", errors=0, missing=0, warnings=(), tables=(), plots={},
        plan=plan, starts=[{"started": "", "platform": "", "git": None, "versions": {}}],
    )  # fmt: skip
    told = dict(re.findall("<tr><th>(.*?)</th><td>(.*?)</td></tr>", page))
    assert {name: told.get(name) for name in plan} == {
        "scale": None,
        "via": None,
        "step_s": "1",
        "redraw": "no",
        "seeds": "0, 1",
        "limits": "a 2",
    }
