"""The layouts, and what they share.

=================  ==============================================================================================
`compass`          as the place looks, from headings alone
`relax`            any drawing with wider angles and more even lengths
`schnyder`         straight lines on an integer grid, in linear time, at any size (``_realizer``)
`tutte`            every vertex at the mean of its neighbours: rounder, for people
`subdivide`        bends for loops and parallel edges, so that the map becomes simple
`triangulate`      edges added inside faces until all are triangles (``_augment``)
=================  ==============================================================================================
"""
