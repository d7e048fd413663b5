"""The engine: conflict-driven search over relation networks, with algebraic closure as its theory.

A literal says "this pair is within this mask", for stated and for derived pairs alike. `search` refines by closure (`sweep`,
`narrow`, `queue`), decides by splitting a label into tractable parts (`decide`), and learns from each conflict a clause
whose reasons are the triangles of closure (`explain`, `analyse`, `clauses`). `graph` says which pairs are kept, `tables`
what the calculus is, `state` and `columns` where everything lies; `engine` drives the kernels in slices and looks at the
clock.
"""
