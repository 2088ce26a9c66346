"""What a scenario of others may make SUMO do: nothing outside a run's scratch folder."""

import errno
import gzip
import re
import shutil
from collections.abc import Mapping
from contextlib import closing, suppress
from pathlib import Path

import pytest

from automotive_cosim import scenarios
from automotive_cosim.errors import ScenarioError, UserError
from automotive_cosim.formats import bounds, files
from automotive_cosim.scenarios import open_scenario
from automotive_cosim.traffic import sumo_programs, vocabulary
from automotive_cosim.traffic.base import EgoPlan
from automotive_cosim.traffic.file_check import copy_vetted, vet
from automotive_cosim.traffic.fork import Forked
from automotive_cosim.traffic.options import INPUTS, Setup, command_line, copied, read_configuration, run_options

NET = (scenarios.load("grid").folder / "grid.net.xml").read_text()
LIGHT = re.search(r'<tlLogic id="([^"]+)".*?</tlLogic>', NET, re.DOTALL)
ROUTE = '<route id="r" edges="cwc0 c0c1 c1c2 c2c3 c3c4 c4ce"/>'
FLOW = '<flow id="f" route="r" begin="0" end="90000" period="6"/>'
SSM = '<param key="has.ssm.device" value="true"/>'

WRITING_OPTIONS = """
    summary-output summary tripinfo tripinfo-output vehroutes netstate ndump netstate-dump fcd-output person-fcd
    full-output save-configuration C save-config save-template save-schema save-state.files log l message-log
    error-log queue-output lanechange-output statistic-output edgedata-output bt-output device.ssm.file
    device.toc.file device.rerouting.output pedestrian.jupedsim.wkt gui-testing.setting-output configuration-file c
""".split()  # noqa: SIM905

WRITING_ELEMENTS = (
    '<e1Detector id="d" lane="c1c2_0" pos="5" period="9" file="@"/>',
    '<inductionLoop id="d" lane="c1c2_0" pos="5" period="9" file="@"/>',
    '<laneAreaDetector id="d" lane="c1c2_0" pos="1" length="5" period="9" file="@"/>',
    '<entryExitDetector id="d" period="9" file="@"><detEntry lane="c1c2_0" pos="1"/>'
    '<detExit lane="c1c2_0" pos="9"/></entryExitDetector>',
    '<instantInductionLoop id="d" lane="c1c2_0" pos="5" file="@"/>',
    '<edgeData id="d" file="@"/>',
    '<laneData id="d" file="@"/>',
    '<routeProbe id="d" edge="c1c2" period="9" file="@"/>',
    '<vTypeProbe id="d" period="9" file="@"/>',
    '<calibrator id="d" edge="c1c2" pos="0" period="9" output="@"><flow begin="0" end="99" route="r" '
    'vehsPerHour="9"/></calibrator>',
    '<timedEvent type="SaveTLSStates" source="%" dest="@"/>',
    '<timedEvent type="SaveTLSSwitchStates" source="%" dest="@"/>',
    '<timedEvent type="SaveTLSProgram" source="%" dest="@"/>',
)

SWARM = '<tlLogic id="%" type="swarm" programID="z" offset="0"><param key="SWARMLOG" value="@"/></tlLogic>'
NESTED_LIGHT = (
    '<tlLogic id="%" type="actuated" programID="y" offset="0"><phase duration="9" state="G">'
    '<param key="file" value="@"/></phase></tlLogic>'
)

WRITING_VEHICLES = (
    f'<vehicle id="v" route="r" depart="0">{SSM}</vehicle>',
    f'<vehicle id="v" route="r" depart="0">{SSM}<param key="device.ssm.file" value="@"/></vehicle>',
    f'<vType id="t">{SSM}<param key="device.ssm.file" value="@"/></vType><vehicle id="v" type="t" route="r" '
    'depart="0"/>',
    f'<vTypeDistribution id="t"><vType id="u" probability="1">{SSM}</vType></vTypeDistribution>'
    '<flow id="g" type="t" route="r" begin="0" end="60" period="9"/>',
    '<vType id="t"><param key="device.toc.file" value="@"/></vType>',
)


def _light(kind: str) -> str:
    assert LIGHT is not None
    text = re.sub(r'type="\w+"', f'type="{kind}"', LIGHT[0], count=1).replace('programID="0"', 'programID="x"')
    writing = (
        '<param key="file" value="@"/><param key="freq" value="9"/><param key="build-all-detectors" value="1"/>'
    )
    return text.replace(">", f">{writing}", 1)


def _written(folder: Path, *, options: str = "", routes: str = "", more: str = "", net: str = "") -> Path:
    """A scenario that begins at 0, with additions to its files; ``@`` is a file in the folder ``out``."""
    assert LIGHT is not None
    out = folder / "out"
    inputs = folder / "in"
    out.mkdir()
    inputs.mkdir()

    def put(name: str, text: str) -> None:
        (inputs / name).write_text(text.replace("@", str(out / "evil.xml")).replace("%", LIGHT[1] if LIGHT else ""))

    put("t.net.xml", NET.replace("</net>", f"{net}</net>"))
    put("t.rou.xml", f"<routes>{ROUTE}{FLOW}{routes}</routes>")
    put("t.add.xml", f"<additional>{more}</additional>")
    put(
        "t.sumocfg",
        '<configuration><input><net-file value="t.net.xml"/><route-files value="t.rou.xml"/>\n'
        f'<additional-files value="t.add.xml"/></input>\n{options}</configuration>',
    )
    return inputs / "t.sumocfg"


def _listing(folder: Path) -> dict[Path, int]:
    return {path: path.stat().st_mtime_ns if path.is_file() else 0 for path in folder.rglob("*")}


def _texts(config: Path, scratch: Path) -> str:
    """Everything that SUMO is told: its command line and the files in it."""
    scratch.mkdir()
    options = run_options(copied(read_configuration(config), scratch), Setup(open_scenario(config)))
    assert {options[name] for name in options if name in INPUTS} <= {file.name for file in scratch.iterdir()}
    return "\n".join([*command_line(options), *(file.read_text() for file in scratch.iterdir())])


# --- the tables ------------------------------------------------------------------------------------------------


def _template(folder: Path) -> dict[str, str]:
    """Every option and synonym of the installed SUMO, with the option's name."""
    file = folder / "template.xml"
    sumo_programs.run("sumo", ["--save-template", file])
    found: dict[str, str] = {}
    for name, attributes in re.findall(r"^ {8}<([^! ]\S*) (.*)/>$", file.read_text(), re.MULTILINE):
        synonyms = re.search(r'synonymes="([^"]*)"', attributes)
        found |= dict.fromkeys((str(name), *(synonyms[1].split() if synonyms else ())), str(name))
    return found


@pytest.mark.sumo
def test_every_option_of_the_installed_sumo_is_in_one_table(tmp_path: Path) -> None:
    meso = {vocabulary.MESOSCOPIC: vocabulary.MESOSCOPIC}
    tables: list[Mapping[str, str]] = [vocabulary.TAKEN, vocabulary.IGNORED, vocabulary.PARALLEL]
    tables += [vocabulary.REFUSED, meso]
    known = {word: name for table in tables for word, name in table.items()}
    assert _template(tmp_path) == known
    assert len(known) == sum(map(len, tables))
    assert not known.keys() & vocabulary.WINDOW.keys()


def test_every_element_of_the_installed_sumo_is_known_and_so_are_those_that_name_files() -> None:
    xsd = sumo_programs.home() / "data" / "xsd"
    forms = (
        "additional_file",
        "net_file",
        "routes_file",
        "tllogic_file",
        "types_file",
        "taz_file",
        "meandata_file",
    )
    forms += ("types/route", "types/taz", "types/base", "types/meandata")
    texts = [(xsd / f"{form}.xsd").read_text() for form in forms]
    assert {name for text in texts for name in re.findall(r'element name="([^"]+)"', text)} == vocabulary.ELEMENTS
    told = set()
    for text in texts:
        elements = dict(re.findall(r'element name="([^"]+)" type="([^"]+)"', text))
        for kind, body in re.findall(r'complexType name="([^"]+)">(.*?)\n    </xsd:complexType>', text, re.DOTALL):
            names = {name for name, of in elements.items() if of == kind}
            files = re.findall(r'attribute name="(file|\w+sFile|output|dest|href)"', body)
            told |= {(name, file) for name in names for file in files}
    undocumented = {("include", "href"), ("rerouter", "file")}
    assert told | undocumented == {*vocabulary.OUTPUTS.items(), *vocabulary.INPUTS.items()}


# --- refused without SUMO --------------------------------------------------------------------------------------


def test_an_option_that_writes_has_no_effect_under_any_name(tmp_path: Path) -> None:
    options = "".join(f'<{option} value="@"/>' for option in WRITING_OPTIONS)
    config = _written(tmp_path, options=f"<anything>{options}</anything>")
    assert "evil" not in _texts(config, tmp_path / "scratch")
    assert len(read_configuration(config).ignored) > 20


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ('<summry value="x"/>', ["line 3", "'summry'"]),
        ('<save-everything value="x"/>', ["line 3", "'save-everything'"]),
        ('<load-state value="x"/>', ["line 3", "<load-state>", "not checked"]),
        ('<phemlight-path value="x"/>', ["line 3", "<phemlight-path>"]),
        ('<mesosim value="true"/>', ["line 3", "mesoscopic", "remove it"]),
        ('<weight-files value="${HOME}/x.xml"/>', ["line 3", "weight-files", "${HOME}", "variables"]),
        ('<device.rerouting.explicit value="$X"/>', ["line 3", "device.rerouting.explicit", "'$X'"]),
        ("<tripinfo-output>@</tripinfo-output>", ["line 3", "write <option value="]),
        ('<weight-files value="none.xml"/>', ["line 3", "none.xml", "missing"]),
        (f'<weight-files value="{"x" * 5000}"/>', ["line 3", "missing"]),
    ],
)
def test_an_option_that_is_not_known_is_named_with_its_line(options: str, words: list[str], tmp_path: Path) -> None:
    config = _written(tmp_path, options=options)
    with pytest.raises(ScenarioError) as caught:
        open_scenario(config)
    assert "\n" not in str(caught.value)
    for word in ("t.sumocfg", *words):
        assert word in str(caught.value)


def test_no_value_passes_as_an_option(tmp_path: Path) -> None:
    config = _written(tmp_path, options='<sloppy-insert value="--save-configuration"/><begin value="--tripinfo"/>')
    configuration = read_configuration(config)
    line = command_line(configuration.options)
    assert "--sloppy-insert=--save-configuration" in line
    assert "--begin=--tripinfo" in line
    assert not {"--save-configuration", "--tripinfo"} & set(line)


@pytest.mark.parametrize("root", ["additional", "routes", "net", "any"])
@pytest.mark.parametrize(
    "element", [*WRITING_ELEMENTS, *WRITING_VEHICLES, _light("actuated"), _light("NEMA"), NESTED_LIGHT, SWARM]
)
def test_what_writes_is_changed_wherever_it_stands(element: str, root: str, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(f"<{root}>{element.replace('@', 'evil.xml')}</{root}>")
    (tmp_path / "scratch").mkdir()
    text = (tmp_path / "scratch" / copy_vetted(tmp_path / "a.xml", tmp_path / "scratch", "copy")).read_text()
    assert len(text) > 30
    assert "evil" not in text
    assert "has.ssm" not in text


@pytest.mark.parametrize("name", ["t.net.xml", "t.rou.xml", "t.add.xml"])
def test_a_packed_file_is_checked_too_whatever_it_is_called(name: str, tmp_path: Path) -> None:
    config = _written(tmp_path, more=WRITING_ELEMENTS[0], routes=WRITING_VEHICLES[1], net=WRITING_ELEMENTS[5])
    file = config.with_name(name)
    file.write_bytes(gzip.compress(file.read_bytes()))
    packed = file.rename(file.with_name(f"{name}.gz"))
    for found in (packed, shutil.copy(packed, file)):
        (tmp_path / "scratch").mkdir()
        copy = tmp_path / "scratch" / copy_vetted(Path(found), tmp_path / "scratch", "copy")
        assert "evil" not in copy.read_text()
        shutil.rmtree(tmp_path / "scratch")


@pytest.mark.parametrize(
    "outer",
    [
        '<include href="inner.xml"/>',
        '<rerouter id="z" edges="c1c2" file="inner.xml"/>',
        '<calibrator id="z" edge="c1c2" pos="0" file="inner.xml"/>',
        '<variableSpeedSign id="z" lanes="c1c2_0" file="inner.xml"/>',
    ],
)
def test_so_is_a_file_that_another_names(outer: str, tmp_path: Path) -> None:
    config = _written(tmp_path, more=outer + '<poly id="p" shape="0,0 1,1" imgFile="a.png"/>')
    inner = config.with_name("inner.xml")
    inner.write_text(f"<additional>{WRITING_ELEMENTS[0].replace('@', 'evil.xml')}</additional>")
    told = _texts(config, tmp_path / "scratch")
    assert "evil" not in told
    assert '"additional-files0-0.xml"' in told
    assert "inner.xml" not in told
    assert "a.png" not in told
    inner.unlink()
    with pytest.raises(ScenarioError, match=r"t\.add\.xml line 1: .*'inner\.xml', which is missing"):
        open_scenario(config)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<additional>\n<e9Detector file='x'/></additional>", "line 2: no element of SUMO named 'e9Detector'"),
        ("<additional xmlns:x='y'>\n<x:include href='x'/></additional>", "line 2: no element of SUMO named 'x:inc"),
        ("<additional>\n\n<vType id='t'><param key='device.new.file' value='x'/></vType></additional>", "line 3"),
        (
            "<additional><vType id='t'><param key='has.new.device' value='1'/></vType></additional>",
            "'has.new.device'",
        ),
        ("<!DOCTYPE a [<!ATTLIST e1Detector file CDATA 'x'>]><a/>", "a document type"),
        ("<!DOCTYPE a SYSTEM 'evil.dtd'><a/>", "a document type"),
        ("<?xml version='1.0' encoding='cp037'?><a/>", "'cp037'"),
        ("<additional><include href='t.add.xml'/></additional>", "includes itself"),
        ("<additional><include href='${HOME}/x.xml'/></additional>", "'${HOME}/x.xml': variables ($) are not"),
        ("<additional>", "is not a SUMO file"),
        ("", "is not a SUMO file"),
    ],
)
def test_a_file_with_what_is_not_known_is_refused_with_its_line(text: str, words: str, tmp_path: Path) -> None:
    config = _written(tmp_path)
    config.with_name("t.add.xml").write_text(text)
    with pytest.raises(ScenarioError) as caught:
        open_scenario(config)
    assert words in str(caught.value)
    assert "t.add.xml" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_options_of_the_window_and_a_microscopic_mesosim_are_passed_over(tmp_path: Path) -> None:
    config = _written(tmp_path, options='<osg-view value="true"/><window-size value="9,9"/><mesosim value="no"/>')
    configuration = read_configuration(config)
    assert {"osg-view", "window-size"} <= set(configuration.ignored)
    assert not {"osg-view", "window-size", "mesosim"} & set(configuration.options)


@pytest.mark.parametrize("element", ["vehicle", "trip", "flow", "person"])
@pytest.mark.parametrize("name", ["a b", "a;b", "a,b", "a|b"])
def test_an_id_that_sumo_does_not_take_is_named_with_its_line(name: str, element: str, tmp_path: Path) -> None:
    config = _written(tmp_path, routes=f'\n<{element} id="{name}" depart="0"/>')
    with pytest.raises(
        ScenarioError, match=rf"t\.rou\.xml line 2: SUMO takes no {element} with the id '{re.escape(name)}'"
    ):
        open_scenario(config)


def test_the_cockpits_car_finds_its_name_free(tmp_path: Path) -> None:
    riding = '<person id="p" depart="0"><ride from="c0c1" to="c1c2" lines="bus ego"/></person>'
    config = _written(
        tmp_path,
        routes='<vType id="ego"/><flow id="ego" route="r" end="9" period="3"/>'
        f'<vehicle id="ego" route="r" depart="0"><stop lane="c1c2_0" join="ego" duration="9"/></vehicle>{riding}',
        options='<device.rerouting.explicit value="a,ego"/>',
    )
    told = _texts(config, tmp_path / "scratch")
    assert '<vehicle id="ego.scenario" route="r"' in told
    assert 'join="ego.scenario"' in told
    assert 'lines="bus ego.scenario"' in told
    assert "--device.rerouting.explicit=a,ego.scenario" in told
    assert '<flow id="ego"' in told
    assert '<vType id="ego"' in told


PLAIN = '<net><location projParameter="!"/><edge id="a"/></net>'


class _Counted:
    """Counts the elements that are read."""

    count = 0

    def start(self, name: str, attributes: dict[str, str], depth: int) -> None:
        self.count += 1


def test_a_file_that_was_checked_is_copied_unread_while_it_is_the_same(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(PLAIN)
    known, read = vet(tmp_path / "a.xml"), _Counted()
    packed = tmp_path / "b.xml.gz"
    packed.write_bytes(gzip.compress(PLAIN.encode()))
    for file in (tmp_path / "a.xml", packed):
        copy = tmp_path / copy_vetted(file, tmp_path, "copy", read, known=known)
        assert (copy.read_text(), read.count) == (PLAIN, 0)
        copy.unlink()
    (tmp_path / "a.xml").write_text(
        PLAIN.replace("</net>", WRITING_ELEMENTS[0].replace("@", "evil.xml") + "</net>")
    )
    copy = tmp_path / copy_vetted(tmp_path / "a.xml", tmp_path, "copy", read, known=known)
    assert "evil" not in copy.read_text()
    assert read.count > 3
    with pytest.raises(ScenarioError, match="missing"):
        copy_vetted(tmp_path / "none.xml", tmp_path, "copy", read, known=known)


class _Depths:
    """Notes how deep elements stand."""

    def __init__(self) -> None:
        self.seen: list[tuple[str, int]] = []

    def start(self, name: str, attributes: dict[str, str], depth: int) -> None:
        self.seen.append((name, depth))


def test_who_reads_along_is_told_how_deep_elements_stand_also_in_what_is_included(tmp_path: Path) -> None:
    (tmp_path / "in.xml").write_text("<routes><vType id='a'><param key='x'/></vType></routes>".replace("'", '"'))
    (tmp_path / "a.xml").write_text('<routes><route/><include href="in.xml"/><route/></routes>')
    read = _Depths()
    with suppress(ScenarioError):  # of the parameter, after all is read
        vet(tmp_path / "a.xml", read)
    assert read.seen[:5] == [("routes", 0), ("route", 1), ("include", 1), ("routes", 2), ("vType", 3)]


@pytest.mark.parametrize(
    "after", ["<net:any/>", "</metadata><any/><metadata>", "</metadata><location/><any/><metadata>"]
)
def test_anything_may_stand_within_metadata_and_nowhere_else(after: str, tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(f"<net><metadata><any><other/></any><metadata/>{after}</metadata></net>")
    if after.startswith("</"):
        with pytest.raises(ScenarioError, match="any"):
            vet(tmp_path / "a.xml")
    else:
        vet(tmp_path / "a.xml")


@pytest.mark.parametrize(
    "element", [*WRITING_ELEMENTS, _light("NEMA"), NESTED_LIGHT, '<include href="a.net.xml"/>']
)
def test_a_file_that_is_not_copied_as_it_is_has_to_be_read_again(element: str, tmp_path: Path) -> None:
    (tmp_path / "a.net.xml").write_text(PLAIN)
    (tmp_path / "b.xml").write_text(PLAIN.replace("</net>", element.replace("@", "evil.xml") + "</net>"))
    assert vet(tmp_path / "a.net.xml")
    assert not vet(tmp_path / "b.xml")


@pytest.mark.parametrize("encoding", ["iso-8859-1", "latin1", "windows-1252", "utf-8", "utf-16"])
def test_letters_are_those_of_the_file_in_whatever_encoding_it_declares(encoding: str, tmp_path: Path) -> None:
    text = f'<?xml version="1.0" encoding="{encoding}"?><additional><poi id="straße" x="1" y="1"/></additional>'
    (tmp_path / "a.xml").write_bytes(text.encode(encoding))
    copy = tmp_path / copy_vetted(tmp_path / "a.xml", tmp_path, "copy")
    from xml.etree import ElementTree as ET

    assert "straße" in ET.tostring(ET.parse(copy).getroot(), "unicode")
    if encoding in ("latin1", "windows-1252"):  # which SUMO need not know
        assert b"encoding" not in copy.read_bytes()


def test_latin_1_that_is_not_declared_is_called_so(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_bytes('<additional><poi id="straße"/></additional>'.encode("latin-1"))
    with pytest.raises(
        ScenarioError, match=r"it is not UTF-8: save it so, or let it begin with <\?xml .*iso-8859-1"
    ):
        copy_vetted(tmp_path / "a.xml", tmp_path, "copy")


def test_a_copy_says_the_same_but_for_the_outputs(tmp_path: Path) -> None:
    text = (
        '<routes><vType id="a&amp;&quot;b">  <param key="device.battery.capacity" value="1"/>%s</vType>\n'
        '<metadata><x:any xmlns:x="y">é &lt; 3</x:any></metadata>'
        '<edge id="e"><param key="any:key" value="x"/></edge></routes>'
    )
    (tmp_path / "a.xml").write_text(text % SSM, encoding="utf-8")
    (tmp_path / "scratch").mkdir()
    copy = tmp_path / "scratch" / copy_vetted(tmp_path / "a.xml", tmp_path / "scratch", "copy")
    from xml.etree import ElementTree as ET

    assert ET.canonicalize(copy.read_text(encoding="utf-8")) == ET.canonicalize(text % "")


@pytest.mark.parametrize("name", scenarios.shipped())
def test_shipped_scenarios_run_as_they_are(name: str, tmp_path: Path) -> None:
    given = read_configuration(scenarios.load(name).config)
    for option, files_ in copied(given, tmp_path).files.items():
        for file, copy in zip(given.files[option], files_, strict=True):
            with files.opened(file) as original:
                assert copy.read_bytes() == original.read(), file


# --- archives --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["t.net.xml", "t.rou.xml", "t.add.xml"])
def test_an_archive_that_unpacks_to_far_more_is_refused(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bounds, "FREELY_UNPACKED_BYTES", 2**20)
    config = _written(tmp_path)
    config.with_name(name).write_bytes(gzip.compress(b"<net>" + b" " * 2**22))
    with pytest.raises(UserError, match="unpacks to over 1 MB; if you trust it, unpack it yourself"):
        open_scenario(config)


# --- with SUMO -------------------------------------------------------------------------------------------------


@pytest.mark.sumo
def test_the_whole_corpus_at_once_writes_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def numbered(texts: tuple[str, ...], prefix: str) -> str:
        own = (re.sub(r' (id|type)="([dtuvg])"', rf' \1="\2{prefix}{n}"', text) for n, text in enumerate(texts))
        return "".join(own)

    config = _written(
        tmp_path,
        options="".join(f'<{option} value="@"/>' for option in WRITING_OPTIONS)
        + '<device.ssm.probability value="1"/><save-state.times value="1"/>',
        routes=numbered(WRITING_VEHICLES, "a") + '<vehicle id="n" type="n" route="r" depart="0"/>',
        more=numbered(WRITING_ELEMENTS, "b") + _light("actuated"),
        net=numbered(WRITING_ELEMENTS[:3], "c") + f'<vType id="n">{SSM}</vType>',
    )
    (tmp_path / "cwd").mkdir()
    monkeypatch.chdir(tmp_path / "cwd")
    monkeypatch.setenv("TMPDIR", str(tmp_path / "tmp"))
    (tmp_path / "tmp").mkdir()
    before = _listing(tmp_path)
    scenario = open_scenario(config)
    plan = EgoPlan(scenario.ego.trips[0])
    with closing(Forked(scenario)) as simulation, closing(simulation.depart(plan)) as traffic:
        traffic.advance(60.0)
        assert traffic.state.vehicle_count > 2
        assert "(deleted)" in str(Path(f"/proc/{traffic.pid}/cwd").readlink())
    assert _listing(tmp_path) == before


def test_a_disk_that_is_full_is_no_fault_of_the_file_that_is_copied(tmp_path, monkeypatch):
    source = tmp_path / "a.rou.xml"
    source.write_text(f"<routes>{ROUTE}</routes>", "utf-8")
    (tmp_path / "copies").mkdir()

    def lack_space(*_, **__):
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr("automotive_cosim.formats.writing.os.replace", lack_space)
    with pytest.raises(OSError, match="No space left"):
        copy_vetted(source, tmp_path / "copies", "a")
