"""An episode: a task, or an agent's turn in a study, played in the running co-simulation.

    EpisodeSpec -> SituationFinder -> HandOver -> Episode -> play(episode, actor) -> verdict

specification  what is to be run, and under which conditions; seeds
listener       hears how an episode comes about
situation      drives until a task's trigger holds, and hands over
session        somebody at the cockpit: perform, advance, observe
baseline       the same drive with nobody at the cockpit
episode        a session that is judged, and can be branched
loop           plays any actor to the end

It knows nothing of gymnasium: ``envs`` adapts it, and so do ``run``, ``proof`` and ``studies``.
"""
