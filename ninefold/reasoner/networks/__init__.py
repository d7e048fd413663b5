"""What follows from relations that were only declared.

=================  ==============================================================================================
`network`          `Network`: statements over one calculus, and their intersection pair by pair
`deciding`         the decision and what shows it; `consistency`, `conflicts` and `enumeration` call it
`consistency`      `check`: consistent with a scenario, inconsistent, or unknown
`scenario`         `Scenario`: one base relation a pair; `completion` makes it of what a decision found, without search
`enumeration`      every scenario, and how many
`inference`        what is feasible, what is entailed, the minimal network
`formula`          Boolean formulas over relation atoms, and `questions`, which answers them
`conflicts`        minimal sets of statements that cannot hold together
`repairs`          the cheapest statements to drop
`derivation`       closure that remembers why; `refutation` adds cases; `explanation` and `words` write both down
`proofs`           proofs of inconsistency and a checker that shares no code with the engine
`clausal`          the same proofs as CNF with DRAT or LRAT, for other checkers; `propositional` is what to trust of that
=================  ==============================================================================================

Deciding is the work of `ninefold.reasoner.engine`. The public names are those of `ninefold.reasoner`.
"""
