"""``automotive-cosim show functions``."""

import json
import re

from automotive_cosim.cockpit.registry import by_any_name


def test_it_lists_every_function_in_words_and_in_the_form_of_each_api(cli):
    ran = cli("show", "functions")
    assert ran.code == 0
    assert "set_hvac_temperature(which: driver|passenger, celsius: 16 to 28)" in ran.out
    every = json.loads(cli("show", "functions", "--json").out)
    assert ran.out.splitlines()[-1].startswith(f"{len(every)} functions")
    assert 60 <= len(every) <= 95
    for option, schema, inside in (
        ("openai", "parameters", "function"),
        ("mcp", "inputSchema", ""),
        ("anthropic", "input_schema", ""),
    ):
        told = json.loads(cli("show", "functions", "--tools", option).out)
        flat = [each[inside] if inside else each for each in told]
        assert [(each["name"], each[schema]) for each in flat] == [(e["name"], e["parameters"]) for e in every]


def test_an_unknown_form_is_refused(cli):
    ran = cli("show", "functions", "--tools", "opnai")
    assert (ran.code, ran.out) == (2, "")
    assert "did you mean 'openai'" in ran.err


def test_every_name_that_opens_an_app_is_listed(cli):
    listed = json.loads(cli("show", "apps", "--json").out)["apps"]
    titles = {each["about"].partition(",")[0].lower() for each in listed}
    names = {each["id"] for each in listed} | {other for each in listed for other in each["also"]}
    assert names | titles == set(by_any_name())
    assert re.search(r"^climate +Climate, in the dock\n +also: hvac$", cli("show", "apps").out, re.MULTILINE)
