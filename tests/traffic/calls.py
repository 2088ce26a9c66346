"""Functions that the tests call in the process of a simulation."""

from automotive_cosim.traffic.running import Running


class Count:
    """Counts steps."""

    steps = 0

    def after_step(self) -> None:
        self.steps += 1


def watch(running: Running) -> None:
    """Counts from now on, in every copy too."""
    running.watchers.append(Count())


def seen(running: Running) -> int:
    """How many steps there were."""
    return running.watcher(Count).steps


def run_on(running: Running, steps: int) -> int:
    """Lets the traffic run without its ego; how many steps there were in all."""
    for number in range(steps):
        running.done = number, steps
        running.step()
    return seen(running)
