"""The engine: a conflict-driven search over relation networks with algebraic closure as its theory.

A search state gives every kept pair of entities a relation, a mask of base relations. Three things make it smaller:
closure over triangles, learned clauses, and splits. All deductions are about *literals* "this pair is in this mask", also
for pairs that nobody stated and that were only derived.

=====================  ============================================================================================
`tables`               a calculus as look-up tables: composition, tractable hulls, splits
`graph`                which pairs are kept: all, or a chordal completion; its complete core
`columns`, `state`     the arrays a search works on, and the names of their columns
`words`, `queue`       sets of nodes as words; the queue that takes the smallest relations first
`narrow`, `sweep`      making a relation smaller and taking it back; closing the triangles over a pair
`clauses`              learned clauses, two watched literals
`explain`, `analyse`   why a pair is in a mask, as weakly as possible; from a conflict to a clause
`decide`, `search`     where to split; the search itself
`engine`               `Engine`: slices of work, room, clean-ups, the clock
=====================  ============================================================================================

A run goes like this. The stated labels are set and closed; that is level 0. Then, as long as some stated pair is not
*settled* (its relation does not fit in a tractable part of its label), such a pair is split, and the split is closed. At an
empty relation the trail is walked backwards: each narrowing is replaced by what its triangle or clause needed, weakened by
table look-up as far as the conflict allows, until one literal of the last level is left. The clause that denies it is
learned, the search jumps back and goes on. When every stated pair is settled, closure over the tractable parts decides: the
network is consistent. When level 0 runs empty it is not, and the learned clauses are the proof.

The two back ends are two frames of one engine. In a dense frame every pair is kept and triangles are closed over
bit-planes, 64 partners at a time. In a chordal frame the pairs of a chordal completion are kept; nearly all of them lie in
its complete core, which is swept over bit-planes, and the others are visited one by one.

What was measured and does not pay: closure only on full assignments; CaDiCaL with closure as a propagator in Python; plain
clauses, on chordal graphs too (a hundred times more memory, and slower).
"""
