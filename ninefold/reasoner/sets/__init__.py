"""Exact relations between the sets of one plane map.

=============  ==================================================================================================
`relation`     `Relation`: nine bits, a DE-9IM string and a word; names, converses and predicates
`relate`       one pair of sets, by the stars at the vertices they share
`bulk`         `relate_pairs`, `relate_all`: the same with 64-bit words, compiled (``_stars``, ``_pairs``)
`nesting`      `containment_tree`: which region lies inside which
=============  ==================================================================================================

The *star* of a set at a vertex says which darts and which wedges between darts belong to it. Two sets are overlaid at the
vertices they share, and every part that shares none is settled by one face search. The public names are those of
`ninefold.reasoner`.
"""
