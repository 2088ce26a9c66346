"""How much rerouting gains, from futures forked from identical traffic.

plan       what a study runs: scenario, departures, seeds, shares, news, policies
batch      drives in parallel, resumed, until the interval is narrow enough
drive      one drive with its decision points, and the branches forked there
futures    drives what follows from a decision, several futures at the same time
whole      whole drives under a policy
points     the futures of one decision, also with many cars on the other route
compare    compares two futures of one instant
driver     drives to the next decision; lets an agent at the cockpit decide
policies   the deciding rules, and their results
results    reads stored results, as data frames
everyone   how an effect is spread over everyone
networks   the same study on several networks
demand     how far the demand is from an equilibrium
data       every future as a row, as files
tracks     where the ego was in every future
live       what can be watched of a running study
decisions  every decision on a page; served: the same for ``serve``
tables, effects, context, charts, page    the report
warnings   what to read before its figures
"""
