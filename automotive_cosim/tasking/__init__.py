"""What a task is, and how it is judged. Pure data and pure predicates: nothing here steps the simulation.

task        the form of a task: halves, start, deadline, taxonomy
moves       the steps of a reference solution
parameters  values drawn for an instance
draws       the streams from which an episode is drawn
instance    a task with its phrasing and parameters drawn
catalogue   tasks by id
triggers    the situation on the road that starts a task
binding     the sign or law that a task rests on in another place than its own
checks      goals as predicates on the state
verdict     success = goal x clean x safe x in time x declared
"""
