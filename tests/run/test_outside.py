"""Agents in processes of their own: what they get, what is left of them, and whose fault it is."""

import json
import signal
import sys
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from automotive_cosim.agents import AgentSettings, Stage, StageName, make_agent
from automotive_cosim.agents.cleanup import remove, tree
from automotive_cosim.agents.wire import LONGEST_BYTES, MOST_VALUES
from automotive_cosim.contracts import Action, ActionType
from automotive_cosim.errors import ActionError, AgentError, ModelError, OutOfBudgetError, UserError
from automotive_cosim.interface.observe import Channel
from automotive_cosim.models import ModelReply
from automotive_cosim.run.fork_server import ForkServer
from automotive_cosim.run.outside import LONGEST_REFUSAL, OutsideAgent, check_agent

pytestmark = pytest.mark.slow

AGENTS = '''
import gc, json, os, pathlib, signal, subprocess, sys, time
from automotive_cosim.errors import ModelError, OutOfBudgetError, TrafficError, TriggerNotReachedError

def say(value): return {"action_type": "answer", "text": str(value)[:120]}

class Base:
    channels = ("elements",)
    def reset(self, goal): self.goal = goal

class Counts(Base):
    """How often has it heard a goal? First halves used to come first."""
    heard = {}
    def reset(self, goal):
        self.heard[goal] = self.heard.get(goal, 0) + 1
        os.environ["HEARD"] = os.environ.get("HEARD", "") + "x"
        pathlib.Path("heard").open("a").write("x")
        self.goal = goal
    def act(self, seen):
        return say([self.heard[self.goal], os.environ["HEARD"], pathlib.Path("heard").read_text()])

class Walks(Base):
    """Everything that it can reach: frames, objects, arguments, environment, files, folders, parents."""
    def act(self, seen):
        found = []
        frame = sys._getframe()
        while frame is not None:
            found.append(repr([*frame.f_globals, *(each for each in frame.f_locals.values() if each is not found)]))
            frame = frame.f_back
        ours = lambda each: str(type(each).__module__).startswith("automotive_cosim")
        found += [repr(each) for each in gc.get_objects() if ours(each)]
        found += [repr(each) for each in gc.get_objects() if isinstance(each, (str, dict, list, tuple))]
        for pid in ("self", os.getppid()):
            for name in ("cmdline", "environ", "comm"):
                found.append(pathlib.Path("/proc", str(pid), name).read_text(errors="replace"))
            for entry in pathlib.Path("/proc", str(pid), "fd").iterdir():
                try: found.append(os.readlink(entry))
                except OSError: pass
            found.append(os.readlink(f"/proc/{pid}/cwd"))
        found += sys.argv + [os.getcwd()] + os.listdir()
        pathlib.Path(__file__).with_name("found").write_text("\\n".join(found))
        return say("done")

class Asks(Base):
    """Speaks the protocol itself."""
    def act(self, seen):
        frame = sys._getframe()
        while "wire" not in frame.f_locals: frame = frame.f_back
        wire = frame.f_locals["wire"]
        told = json.loads(pathlib.Path(__file__).with_name("told").read_text())
        if isinstance(told, str): wire.send(told.encode())
        elif isinstance(told, int): wire._socket.sendall(told.to_bytes(8, "big"))
        else: wire.send_json(told)
        time.sleep(600)

class Forks(Base):
    """Leaves processes behind: in its group, in a session of their own, and orphans of those."""
    def act(self, seen):
        pids = [subprocess.Popen(["sleep", "600"]).pid]
        read, write = os.pipe()
        if not os.fork():
            os.setsid()
            if os.fork(): os._exit(0)
            os.write(write, str(os.getpid()).encode())
            time.sleep(600)
        pids.append(int(os.read(read, 20)))
        return say(",".join(map(str, pids)))

class Raises(Base):
    def act(self, seen): raise {"model": ModelError, "trigger": TriggerNotReachedError, "traffic": TrafficError,
        "key": KeyError, "exit": SystemExit, "budget": OutOfBudgetError}[self.goal]("no")

class Ends(Base):
    def act(self, seen):
        if self.goal == "exit": os._exit(3)
        if self.goal == "kill": os.kill(os.getpid(), 9)
        if self.goal == "segfault": os.kill(os.getpid(), signal.SIGSEGV)
        if self.goal == "fork server": os.kill(os.getppid(), 9)
        if self.goal == "interrupt": raise KeyboardInterrupt
        if self.goal == "closes": os.closerange(3, 100)
        if self.goal == "stop": os.kill(os.getpid(), signal.SIGSTOP)
        time.sleep(600)

class ReadsSlowly(Base):
    """Reads half of the second observation, thinks, and answers at once when it has read the rest."""
    channels = ("screenshot",)
    def act(self, seen):
        frame = sys._getframe()
        while "wire" not in frame.f_locals: frame = frame.f_back
        wire, answer = frame.f_locals["wire"], {"action": say("?")}
        wire.send_json(answer)
        while True:
            size = int.from_bytes(wire._read(8, None), "big")
            wire._read(size // 2, None)
            time.sleep(float(self.goal))
            wire._read(size - size // 2, None)
            wire.send_json(answer)

class Litters(Base):
    """Leaves a folder from which nothing can be removed by walking down, and nothing readable."""
    def act(self, seen):
        for name in "abc": pathlib.Path(name).mkdir(); (pathlib.Path(name) / "file").touch()
        os.symlink("/", "link")
        os.mkfifo("pipe")
        os.chmod("b", 0)
        for _ in range(3000):
            os.mkdir("d")
            os.chdir("d")
        return say("done")

class Kills(Base):
    """Its daemon ends or stops the process that its own was forked from, and lives on."""
    def act(self, seen):
        fork_server = os.getppid()
        read, write = os.pipe()
        if not os.fork():
            os.setsid()
            if os.fork(): os._exit(0)
            os.write(write, str(os.getpid()).encode())
            signal.signal(signal.SIGTERM, signal.SIG_IGN)
            time.sleep(0.3)
            os.kill(fork_server, signal.SIGKILL if self.goal == "kill" else signal.SIGSTOP)
            time.sleep(600)
        return say(os.read(read, 20).decode())

class Chains(Base):
    """A chain of processes, each the child of the one before."""
    def act(self, seen):
        read, write = os.pipe()
        for _ in range(300):
            if os.fork(): time.sleep(600)
        os.write(write, b"x")
        time.sleep(600)

class Says(Base):
    """Raises with the text that stands in a file."""
    def act(self, seen):
        said = json.loads(pathlib.Path(__file__).with_name("told").read_text())
        from automotive_cosim.errors import ActionError
        kinds = {"action": ActionError, "budget": OutOfBudgetError, "other": ValueError, "base": KeyboardInterrupt}
        raise kinds[self.goal](said)

class CannotEvenSay(Base):
    def act(self, seen):
        class Silent(Exception):
            def __str__(self): raise self
        raise Silent

class FailsInReset(Base):
    def reset(self, goal): raise ModelError("no")
    def act(self, seen): return say("?")

class CannotBeMade(Base):
    def __init__(self): raise ModelError("no")
    def act(self, seen): return say("?")
'''


@pytest.fixture(scope="module")
def fork_server():
    with closing(ForkServer()) as shared:
        yield shared


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A working folder with agents of somebody's own."""
    (tmp_path / "mine.py").write_text(AGENTS)
    monkeypatch.delitem(sys.modules, "mine", raising=False)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def outside(fork_server, mine):
    """Makes an agent and tells it the goal; at the end nothing of it is left."""
    made = []

    def make(name, goal="", **limits):
        agent = OutsideAgent(fork_server, f"mine:{name}" if name[0].isupper() else name, **limits)
        made.append(agent)
        agent.reset(goal)
        return agent

    yield make
    for agent in made:
        agent.close()


def lives(pid):
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except FileNotFoundError:
        return False


def test_an_agent_outside_does_what_it_does_inside(fork_server, observation):
    screen = np.random.default_rng(0).integers(0, 255, (72, 128, 3), np.uint8)
    seen = [observation("Watch my speed", screenshot=screen, time_s=float(second)) for second in range(3)]
    for name in ("t3a", "m3a", "asurada"):
        inside = make_agent(name)
        with closing(OutsideAgent(fork_server, name, "rules", AgentSettings())) as agent:
            assert agent.channels == inside.channels
            for each in (inside, agent):
                each.reset("Watch my speed")
            for now in seen:
                assert agent.act(now) == inside.act(now)
                assert agent.stages == tuple(inside.stages)


def test_an_agent_that_counts_what_it_heard_has_nothing_to_count(outside):
    said = [outside("Counts", "Watch my speed").act(None).text for _ in range(3)]
    assert said == ["[1, 'x', 'x']"] * 3


def test_an_agent_that_looks_everywhere_finds_nothing_of_the_job(outside, mine, observation, monkeypatch):
    secret = "hvac_fan_max-first-s17"  # what names a job, in every place where a worker may have it
    monkeypatch.setenv("AUTOMOTIVE_COSIM_JOB", secret)
    monkeypatch.setenv("OLDPWD", secret)
    monkeypatch.setattr(sys, "argv", [*sys.argv, secret])
    with (mine / secret).open("w"):
        outside("Walks", "Watch my speed").act(observation("Watch my speed"))
    found = (mine / "found").read_text(errors="replace")
    assert "Watch my speed" in found, "it looked at too little"
    assert secret not in found.replace(str(mine / secret), "")
    for word in ("EpisodeSetup(", "Instance(", "Task("):
        assert word not in found


def test_every_episode_has_an_empty_folder_that_goes_with_it(outside, mine):
    agent = outside("Counts", "x")
    folder = agent._folder
    agent.act(None)
    assert (folder / "heard").is_file()
    agent.close()
    assert not folder.exists()
    assert sorted(path.name for path in mine.iterdir() if path.suffix == ".py") == ["mine.py"]


def test_nothing_that_an_agent_starts_outlives_it(outside):
    agent = outside("Forks")
    pids = agent.act(None).text.split(",")
    assert all(lives(pid) for pid in pids)
    agent.close()
    assert not any(lives(pid) for pid in pids)


@pytest.mark.parametrize("what", ["model", "trigger", "traffic", "key", "exit"])
def test_no_error_that_an_agent_raises_is_anybody_elses(outside, what):
    with pytest.raises(ActionError, match=r"raised \w+: '?no"):
        outside("Raises", what).act(None)


def test_an_agent_may_give_up(outside):
    with pytest.raises(OutOfBudgetError):
        outside("Raises", "budget").act(None)


@pytest.mark.parametrize(
    ("goal", "said"),
    [
        ("exit", "exited with code 3"),
        ("kill", "killed by SIGKILL"),
        ("segfault", "killed by SIGSEGV"),
        ("fork server", "process"),
        ("interrupt", "raised KeyboardInterrupt"),
        ("closes", "closed its connection"),
        ("stop", "over 0.5 s for one step"),
        ("sleep", "over 0.5 s for one step"),
    ],
)
def test_an_agent_that_ends_or_hangs_has_failed(outside, monkeypatch, goal, said):
    monkeypatch.setattr("automotive_cosim.run.outside.GRACE_S", 0.5)
    agent = outside("Ends", goal, step_s=0.5)
    for _ in range(2):
        with pytest.raises(AgentError, match=said):
            agent.act(None)
    assert outside("Counts", "next").act(None).text.startswith("[1")


def test_all_steps_together_have_a_limit_too(outside):
    agent = outside("Ends", "sleep", episode_s=0.5)
    with pytest.raises(AgentError, match=r"over 0\.5 s in the whole episode"):
        agent.act(None)


@pytest.mark.parametrize("name", ["FailsInReset", "CannotBeMade"])
def test_one_that_fails_before_its_first_turn_has_failed_too(outside, name):
    agent = outside(name)
    assert agent.channels == (frozenset() if name == "CannotBeMade" else {Channel.ELEMENTS})
    with pytest.raises(AgentError, match="ModelError: no"):
        agent.act(None)


@pytest.mark.parametrize(
    "told",
    [
        '"nonsense"', '""', '"[1]"', '"\\u0000"', '"' + "[" * 100_000 + '"', "{}", '{"channels": []}',
        '{"action": 7}', '{"action": {"action_type": "fly"}}', '{"refused": null}', '{"failed": {"a": 1}}',
        '{"ask": [{"role": "user", "text": "?"}]}', str(LONGEST_BYTES + 1), str(2**63), "5",
    ],
)  # fmt: skip
def test_nonsense_on_the_wire_is_the_agents_failure_or_its_step(outside, mine, told):
    (mine / "told").write_text(told)
    with pytest.raises((ActionError, AgentError)):
        outside("Asks", step_s=0.5).act(None)


@pytest.mark.parametrize(
    "told",
    [
        {"refused": ["x"]}, {"spent": {"a": 1}}, {"failed": 7}, {"channels": {"a": 1}},
        {"stages": 7, "action": None},
        {"action": {"action_type": ["wait"]}}, {"action": {"action_type": "wait", "seconds": True}},
        {"action": {"action_type": "wait", "seconds": 10**400}}, {"action": [[[]]]}, {"action": "[" * 5000},
        {"action": {"action_type": "click", "x": float("nan"), "y": 1}}, {"action": {"a" * 100_000: 1}},
    ],
)  # fmt: skip
def test_odd_types_on_the_wire_are_the_agents_failure_or_its_step(outside, mine, told):
    (mine / "told").write_text(json.dumps(told))
    with pytest.raises((ActionError, AgentError)):
        outside("Asks", step_s=5.0).act(None)


@pytest.mark.parametrize("what", ["refused", "failed", "spent"])
def test_deep_json_on_the_wire_is_the_agents_failure(outside, mine, what):
    deep = "[" * 900 + "]" * 900
    (mine / "told").write_text(json.dumps(f'{{"{what}": {deep}}}'))
    with pytest.raises(AgentError, match="not an answer"):
        outside("Asks", step_s=5.0).act(None)


def test_json_of_too_many_values_is_refused_before_it_is_made(outside, mine):
    (mine / "told").write_text(json.dumps('{"a": [' + "[]," * MOST_VALUES + "0]}"))
    with pytest.raises(AgentError, match="values"):
        outside("Asks", step_s=20.0).act(None)


@pytest.mark.parametrize(
    ("goal", "error"),
    [("action", ActionError), ("budget", OutOfBudgetError), ("other", ActionError), ("base", AgentError)],
)
@pytest.mark.parametrize("said", ["half \ud800 pair", "\udfff", "\x00\x1b[31m", "\ud83d\ude00", "x" * 100_000])
def test_whatever_an_agent_says_can_be_stored(outside, mine, goal, error, said):
    (mine / "told").write_text(json.dumps(said))
    with pytest.raises(error) as raised:
        outside("Says", goal).act(None)
    str(raised.value).encode()
    assert len(str(raised.value)) <= LONGEST_REFUSAL + 100


def test_an_error_without_words_is_its_own_failure(outside):
    with pytest.raises((ActionError, AgentError)):
        outside("CannotEvenSay").act(None)


def test_the_clock_runs_while_an_agent_reads(outside, observation):
    screen = np.random.default_rng(0).integers(0, 255, (720, 1280, 3), np.uint8)
    agent = outside("ReadsSlowly", "0.2")
    agent.act(observation("x", screenshot=screen))
    for _ in range(2):
        agent.act(observation("x", screenshot=screen))
        assert agent.answer_s >= 0.2


def test_reading_and_answering_have_one_limit(outside, observation):
    screen = np.random.default_rng(0).integers(0, 255, (720, 1280, 3), np.uint8)
    agent = outside("ReadsSlowly", "600", step_s=0.5)
    agent.act(observation("x", screenshot=screen))
    with pytest.raises(AgentError, match=r"over 0\.5 s for one step"):
        agent.act(observation("x", screenshot=screen))
    assert agent._episode_s - agent._left_s >= 0.5
    agent = outside("ReadsSlowly", "0.2", episode_s=3.0)
    for _ in range(2):
        agent.act(observation("x", screenshot=screen))
    agent._left_s = 0.1
    with pytest.raises(AgentError, match="over 3 s in the whole episode"):
        agent.act(observation("x", screenshot=screen))


def test_agents_of_several_cars_live_side_by_side_and_end_by_themselves(outside, until):
    agents = [outside("Forks") for _ in range(3)]
    left = [[int(pid) for pid in agent.act(None).text.split(",")] for agent in agents]
    agents[0].close()
    until(lambda: not lives(left[0][0]))
    assert all(lives(pid) for pids in left[1:] for pid in pids)
    assert agents[1].act(None).text
    for agent in agents[1:]:
        agent.close()
    assert not any(lives(pid) for pids in left for pid in pids), "an orphan outlived the last agent"


@pytest.mark.parametrize("how", ["kill", "stop"])
def test_nothing_outlives_an_agent_that_turns_on_the_process_it_was_forked_from(outside, monkeypatch, until, how):
    monkeypatch.setattr("automotive_cosim.run.fork_server.END_S", 1.0)
    agent = outside("Kills", how, step_s=1.0)  # the second step waits for whom it killed
    pid = agent.act(None).text
    fork_server = agent._fork_server._popen.pid
    assert lives(pid)
    until(lambda: Path(f"/proc/{fork_server}/stat").read_text().rpartition(")")[2].split()[0] in "ZT")
    if how == "kill":
        with pytest.raises(AgentError):
            agent.act(None)
    agent.close()
    assert not lives(pid)
    assert not lives(fork_server)
    assert outside("Counts", "next").act(None).text.startswith("[1")


def test_a_long_chain_of_processes_ends_too(outside):
    agent = outside("Chains", step_s=1.0)
    agent.channels  # noqa: B018, starts it
    fork_server = agent._fork_server._popen.pid
    with pytest.raises(AgentError, match="for one step"):
        agent.act(None)
    assert tree(fork_server) == (fork_server,)


def test_what_an_agent_leaves_in_its_folder_is_removed_however_deep(outside, until):
    agent = outside("Litters")
    folder = agent._folder
    assert agent.act(None).text == "done"
    agent.close()
    until(lambda: not folder.exists())
    assert Path("/etc").is_dir()


def test_a_link_in_the_place_of_the_folder_leads_nowhere(tmp_path):
    (tmp_path / "kept").mkdir()
    (tmp_path / "kept" / "file").touch()
    (tmp_path / "link").symlink_to(tmp_path / "kept")
    remove(tmp_path / "link")
    assert not (tmp_path / "link").is_symlink()
    assert (tmp_path / "kept" / "file").is_file()


def test_a_pickle_on_the_wire_runs_nothing(outside, mine):
    (mine / "told").write_text('"' + "cos\\nsystem\\n(S'touch ran'\\ntR." + '"')
    with pytest.raises(AgentError, match="not an answer"):
        outside("Asks", step_s=1.0).act(None)
    assert not (mine / "ran").exists()


class Model:
    name, sees_pictures = "says", True

    def __init__(self, answer):
        self.answer, self.asked = answer, []

    def chat(self, messages):
        self.asked.append(messages)
        if isinstance(self.answer, Exception):
            raise self.answer
        return self.answer


def test_only_this_sides_model_reports_an_error_of_a_model(fork_server, observation):
    with closing(OutsideAgent(fork_server, "t3a", chat_model=Model(ModelError("no answer")))) as agent:
        agent.reset("x")
        with pytest.raises(ModelError, match="no answer"):
            agent.act(observation("x"))


def test_pictures_reach_the_model_and_its_answer_comes_back_whole(fork_server, observation):
    model = Model(ModelReply('Action: {"action_type": "wait"}', 7, 8, 0.5, 1.5, "length"))
    screen = np.zeros((72, 128, 3), np.uint8)
    with closing(OutsideAgent(fork_server, "m3a", chat_model=model)) as agent:
        agent.reset("x")
        assert agent.act(observation("x", screenshot=screen)) == Action(ActionType.WAIT)
        assert [stage.reply for stage in agent.stages if stage.reply] == [model.answer]
        assert agent.answer_s == 1.5
    ((message,),) = model.asked
    assert len(message.pictures) == 2
    assert all(picture.startswith(b"\x89PNG") for picture in message.pictures)


def test_what_a_model_said_and_cost_is_told_by_this_side_alone(fork_server):
    """Whoever wrote the agent cannot forge its model's figures, nor leave an answer out."""
    one, two = ModelReply("one", 7, 8, 0.5), ModelReply("two", 70, 80, 5.0)
    forged = Stage(StageName.INTERPRET, "I", 3.0, ModelReply("other", -5, 10**15, float("-inf"))).as_json()
    with closing(OutsideAgent(fork_server, "t3a", chat_model=Model(one))) as agent:
        for said, told, replies in (
            ([one, two], [forged, forged], [one, two]),
            ([one, two], [forged, forged | {"reply": None}], [one, None, two]),
            ([one], [forged, forged], [one, None]),
            ([one], [], [one]),
        ):
            agent._replies = said
            assert [stage.reply for stage in agent._stages(SimpleNamespace(time_s=4.0), told)] == replies


def test_an_agent_reads_the_format_of_its_model_from_the_whole_name(fork_server, observation):
    model, screen = Model(ModelReply("Action: press_home()")), np.zeros((720, 1280, 3), np.uint8)
    named = "local/m?format=ui-tars-1.5"
    with closing(OutsideAgent(fork_server, "native", named, chat_model=model)) as agent:
        agent.reset("x")
        assert agent.act(observation("x", screenshot=screen)) == Action(ActionType.NAVIGATE_HOME)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("spec", "said"),
    [
        ("nowhere_to_be_found:X", "cannot import"),
        ("mine:Nobody", "has no Nobody"),
        ("mine:CannotBeMade", "ModelError"),
    ],
)
def test_one_that_cannot_be_made_is_told_before_anything_runs(mine, fork_server, monkeypatch, spec, said):
    lent = SimpleNamespace(start=fork_server.start, end=fork_server.end, close=lambda: None)
    monkeypatch.setattr("automotive_cosim.run.outside.ForkServer", lambda: lent)
    with pytest.raises(UserError, match=said):
        check_agent(spec)
    assert "mine" not in sys.modules, "its module ran in this process"


@pytest.mark.slow
def test_nothing_is_left_of_a_worker_that_was_killed(program, mine, until):
    (mine / "go.py").write_text(
        "import sys; from automotive_cosim.run.fork_server import ForkServer\n"
        "from automotive_cosim.run.outside import OutsideAgent\n"
        "agent = OutsideAgent(ForkServer(), 'mine:Forks'); agent.reset('')\n"
        "print(agent._fork_server._popen.pid, agent.act(None).text.replace(',', ' '), agent._folder, flush=True)\n"
        "input()\n"
    )
    process = program(sys.executable, "go.py", cwd=mine, stdout=-1, stdin=-1)
    pids = process.stdout.readline().split()
    folder = Path(pids.pop())
    assert folder.is_dir()
    assert all(lives(pid) for pid in pids)
    process.send_signal(signal.SIGKILL)
    until(lambda: not any(lives(pid) for pid in pids) and not folder.exists())
