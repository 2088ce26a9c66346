"""The policies that decide whether to reroute, and their results, judged on futures that have all been driven."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from statistics import fmean

from automotive_cosim.errors import UnknownNameError, UserError
from automotive_cosim.studies.reroute.rows import Decision

AGENT = "agent:"
DELAY = "delay:"
WORTHWHILE = "worthwhile:"


class PolicyRule(StrEnum):
    """How a policy decides."""

    NEVER = "never"
    ALWAYS = "always"
    """Takes the quickest other route by the news, even if the news says that it is slower."""
    DELAY = "delay"
    """Takes it if enough delay is expected on the present route and the other is expected to be quicker."""
    WORTHWHILE = "worthwhile"
    """Takes it if it is expected to be quicker by a factor and by a time."""
    SUMO = "sumo"
    """Takes the route of SUMO's rerouting device."""
    BEST = "best"
    """Knows how every future ends: the best possible result with the same choices."""
    AGENT = "agent"
    """An agent of the benchmark at the cockpit."""


@dataclass(frozen=True, slots=True)
class Policy:
    """A rule that decides whether to reroute."""

    text: str
    """Its name as given."""
    rule: PolicyRule
    delay_s: float = 0.0
    factor: float = 1.0
    """How many times as long the present route must take at least."""
    gain_s: float = 0.0
    """How much longer it must take at least."""
    agent: str = ""

    @property
    def words(self) -> str:
        """What it does, for legends."""
        match self.rule:
            case PolicyRule.DELAY:
                return f"from {self.delay_s:g} s of delay on"
            case PolicyRule.WORTHWHILE:
                return f"if {self.factor:g} times and {self.gain_s:g} s quicker"
            case PolicyRule.SUMO:
                return "SUMO's device"
            case PolicyRule.BEST:
                return "best, in hindsight"
            case PolicyRule.AGENT:
                return f"agent {self.agent}"
        return self.text

    def leaves(self, stay_s: float | None, delay_s: float, offered_s: float | None) -> bool:
        """Whether a policy that goes by the news takes the other route.

        Args:
            stay_s: expected travel time on the present route; None if the news does not have it.
            delay_s: how much more of it than on empty roads.
            offered_s: expected travel time on the quickest other route; None without one."""
        if self.rule is PolicyRule.ALWAYS:
            return True
        if stay_s is None or offered_s is None or offered_s >= stay_s:
            return False
        if self.rule is PolicyRule.DELAY:
            return delay_s >= self.delay_s
        return stay_s >= self.factor * offered_s and stay_s - offered_s >= self.gain_s


def parse_policy(text: str) -> Policy:
    """Reads ``never``, ``always``, ``delay:60``, ``worthwhile:1.2:60``, ``sumo``, ``best`` or ``agent:asurada``.

    Raises UserError: it is none of them."""
    if text.startswith(AGENT) and text != AGENT:
        return Policy(text, PolicyRule.AGENT, agent=text.removeprefix(AGENT))
    if text.startswith(DELAY):
        try:
            delay_s = float(text.removeprefix(DELAY))
        except ValueError:
            delay_s = math.nan
        if not 0 <= delay_s <= 3_600:
            raise UserError(f"policy {text!r} requires seconds of delay from 0 to 3600, as in delay:60")
        return Policy(text, PolicyRule.DELAY, delay_s=delay_s)
    if text.startswith(WORTHWHILE):
        try:
            factor, gain_s = map(float, text.removeprefix(WORTHWHILE).split(":"))
        except ValueError:
            factor = gain_s = math.nan
        if not (1 <= factor <= 100 and 0 <= gain_s <= 3_600):
            raise UserError(
                f"policy {text!r} requires a factor from 1 to 100 and seconds from 0 to 3600 by which the other "
                "route is quicker, as in worthwhile:1.2:60"
            )
        return Policy(text, PolicyRule.WORTHWHILE, factor=factor, gain_s=gain_s)
    if text not in {PolicyRule.NEVER, PolicyRule.ALWAYS, PolicyRule.SUMO, PolicyRule.BEST}:
        known = (PolicyRule.NEVER, PolicyRule.ALWAYS, PolicyRule.SUMO, PolicyRule.BEST)
        raise UnknownNameError("policy", text, (*known, "delay:60", "worthwhile:1.2:60", "agent:asurada"))
    return Policy(text, PolicyRule(text))


def chosen(policy: Policy, decision: Decision, age_s: float, compliance: float = 1.0) -> int | None:
    """The future that a policy's choice leads to.

    Args:
        age_s: age of its news; SUMO's device, hindsight and agents have their own.
        compliance: how probably the driver follows the advice; hindsight needs no driver.

    Returns:
        The number of the branch; None for keeping the route."""
    news = next(each for each in decision.news if each.age_s == age_s)
    match policy.rule:
        case PolicyRule.NEVER:
            return None
        case PolicyRule.BEST:
            return best(decision)
        case PolicyRule.AGENT:
            number: int | None = decision.agents[policy.agent]
        case PolicyRule.SUMO:
            number = decision.own
        case PolicyRule.ALWAYS | PolicyRule.DELAY | PolicyRule.WORTHWHILE:
            leaves = policy.leaves(news.stay_s, news.delay_s, news.offered_s)
            number = news.branch if leaves else None
    return number if decision.complies(compliance) else None


def drawn_choices(
    policy: Policy, decision: Decision, age_s: float, compliance: float = 1.0
) -> tuple[int | None, ...]:
    """What a policy chooses in each draw of the futures: always the same, except for ``best``."""
    if policy.rule is PolicyRule.BEST:
        return hindsight(decision)
    return (chosen(policy, decision, age_s, compliance),) * decision.draws


def hindsight(decision: Decision) -> tuple[int | None, ...]:
    """The best choice for each draw, made by all other draws, including those that are in no mean.

    If the same draw chose and scored, the best of several equal futures would gain by luck. A single draw has no
    others, so it chooses for itself."""
    if decision.draws == 1:
        return (best(decision),)
    return tuple(best(decision, without=draw) for draw in range(decision.draws))


def best(decision: Decision, without: int | None = None) -> int | None:
    """The branch with the shortest mean travel time; None if keeping the route is as short.

    Args:
        without: a draw to ignore."""
    draws = [draw for draw in range(decision.draws) if draw != without]
    times = {
        number: fmean(decision.gain(draw, number).time_s for draw in draws)
        for number in range(len(decision.branches))
    }
    quickest = max(times, key=lambda number: times[number], default=None)
    return quickest if quickest is not None and times[quickest] > 0 else None
