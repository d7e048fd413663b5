"""The robust half of mapping and localization: from headings that err, with every doubt named.

**Which map?** `estimate` returns every map that a walk with recognised places leaves.

=============  ==================================================================================================
`noise`        what a compass is declared to err by, and the thresholds that keep the promise
`evidence`     the walk as arrays: visits, legs, lists of exits
`exit_lists`   lists of exits laid over each other; how the frame stood at every visit
`ways`         which legs went the same way, and the readings that leaves open
`orders`       the orders of the ways around one place that legs and lists leave open
`legality`     whether a part of a map is plane and turns as it must
`settling`     what genus and turning leave of all that, searched exactly in independent groups
`whole_turns`  which face is the outer one, where whole turns are not certain
`reading`      one reading of the walk, settled, and its maps
`outcome`      from the evidence to all readings
`doubts`       what is left open, in words, and which walk would settle it
`estimate`     `estimate` and `Estimate`: the maps that are left, or what is in doubt
=============  ==================================================================================================

**The promise.** Errors independent, zero-mean, Gaussian, standard deviation at most sigma; places and exit counts right; the
true map is among those returned except with probability at most (alternatives examined) x 1e-9; one map is called certain
only if it is the only one left; else the undecided places, their remaining orders, pairs that may be one or two ways, and
the number of maps are named; no map left means more noise than declared.

Every step keeps what it cannot exclude at those odds: an order that noise could have turned round, a bundle of legs that may
be two ways, a whole turn that was sampled too coarsely. What falls falls by genus and turning, which pass from a map to its
parts and so never exclude the truth.

**Who is right?** Of claims that visits are the same places, `claims` rejects the cheapest so that the rest can be right.

=============  ==================================================================================================
`claims`       `claims` and `Claims`: the cheapest to reject, each with its reason
=============  ==================================================================================================

``_congruence`` has what follows from claims, with reasons; ``_held`` asks whether some legal map holds them.

**Where on it?** A robot that was switched on somewhere looks at exits and moves, and the belief over the places of a map is
exact under the declared noise.

=============  ==================================================================================================
`localizer`    `Localizer`: what is seen and walked, one thing after another, narrows where the robot can be
`following`    `locate`, `Follower`: a localizer taken along a walk, event by event
=============  ==================================================================================================

**Which places are the same?** Where places look alike, `hypotheses` returns every plane map that explains a walk.

====================  ===========================================================================================
`walk_tree`           the walk folded to a tree of nodes, of which every map is a quotient
`likeness`            which nodes can be one place, under which shifts
`quotients`           the search: a map with stubs that grows by splitting faces
`quotient_sat`        the same by SAT on pairs of nodes, cut where faces turn wrongly
`quotient_portfolio`  both in turn, for closed maps
`hypotheses`          `hypotheses`, `Hypotheses`, `Hypothesis`: the maps, ranked
`consequences`        what follows if two nodes are one place
`why_not`             why two visits are not the same place, as a value
`turning_faces`       faces and loops that turn as none does in the plane
`existence`           whether there is a map at all
`stretches`           the smallest stretch of a walk that already cannot be
`comparing`           how one map of a walk differs from another, place by place
`untravelled`         a map with an unknown place behind every exit that nobody walked
`among`               `locate_among`: which of several maps is right, and where on it the robot is
`claims`              `claims`: which of many claims that visits are one place cannot be right
====================  ===========================================================================================

**Where to go, and what two know together.**

==============  =================================================================================================
`ask_driven`    `AskDriven`: explore until it is settled whether a place is inside a cycle
`doubt_driven`  `DoubtDriven`: explore until one map is left, where no place is recognised
`opening`       `open_map`: what a walk, a hypothesis or a plane map knows, with the exits nobody walked
`merging`       `merge`, `overlaps`: maps of two robots, laid over each other
`joining`       `joined`: two walks as one, for robots that recognise no place
==============  =================================================================================================

`Stars` (in ``_stars``) holds the exits of every place by heading; ``_matching`` weighs all ways in which the exits seen can
be those of a place; ``_ahead`` looks where to go. The public names are those of `ninefold.mapping`.
"""
