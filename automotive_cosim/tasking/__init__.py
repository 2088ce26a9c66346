"""What a task is, and how it is judged. Pure data and pure questions: nothing here steps the world.

task        the form of a task: halves, start, deadline, taxonomy
moves       the steps of a reference solution
parameters  what is drawn for an instance
instance    a task with its words and parameters drawn
catalogue   tasks by id
triggers    which situation on the road starts a task
checks      what a goal asks of the state
verdict     success = goal x clean x safe x in time x declared
"""
