"""What pages share."""

import re

from automotive_cosim.report.templates import render


def test_a_manifest_lists_what_was_given_and_no_none() -> None:
    plan = {
        "scenario": "grid",
        "scale": None,
        "via": [],
        "step_s": 1.0,
        "redraw": False,
        "seeds": [0, 1],
        "limits": {"a": 2, "b": None},
    }
    starts = [{"started": "", "platform": "", "git": None, "versions": {}}]
    nothing = dict.fromkeys(("title", "about", "answer", "picture"), "") | dict.fromkeys(("warnings", "tables"), ())
    page = render(
        "studies/network.html", **nothing, plots={}, errors=0, missing=0, plan=plan, starts=starts, of="run"
    )
    told = dict(re.findall("<tr><th>(.*?)</th><td>(.*?)</td></tr>", page))
    assert {name: told.get(name) for name in plan} == {
        "scenario": "grid",
        "scale": None,
        "via": None,
        "step_s": "1",
        "redraw": "no",
        "seeds": "0, 1",
        "limits": "a 2",
    }


def test_a_setting_of_several_lines_keeps_them():
    from automotive_cosim.report.templates import _ENVIRONMENT

    rows = _ENVIRONMENT.from_string(
        '{% from "report/macros.html" import named_rows %}{{ named_rows(pairs) }}'
    ).render(pairs=[("space", "[factors]\nseed = 1\n"), ("seed", 0)])
    assert "<pre>[factors]\nseed = 1</pre>" in rows
    assert "<td>0</td>" in rows
