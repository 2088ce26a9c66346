"""Episodes: a task, or an agent's turn in a study, played in the running co-simulation.

    EpisodeSpec -> SituationFinder -> HandOver -> Episode -> play(episode, actor) -> verdict

settings       what to run and where, as words
specification  what to run, and under which conditions; seeds
observer       watches the progress of an episode
situation      drives until a task's trigger holds, and hands over
session        an agent at the cockpit: perform, advance, observe; plays any actor to the end
judged         a session that is judged, beside the same drive with nobody at the cockpit
episode        a session on a task, which can be branched

It does not depend on gymnasium: ``envs`` adapts it, and so do ``run``, ``proof`` and ``studies``.
"""
