"""From directions to a plane picture: what the compass and the relaxed layouts share.

=============  ==================================================================================================
`pieces`       a map cut into straight pieces with wanted directions, turned until the rotation holds
`directions`   the shape that directions fix, by reweighted least squares; it may cross itself
`blocks`       2-connected parts and how they hang from each other
`hung`         parts that hang by one vertex, turned into their place and shrunk where they are in the way
`mesh`         faces cut into triangles inside a frame that stands still; diagonals flip
`energy`       pulls on pieces and the shape of triangles; one damped Newton step that folds nothing that is right
`untangle`     rounds of such steps until no triangle is folded; mending what is stuck; back towards the shape
`picture`      all of that in its order: from pieces to a mesh whose triangles are all the right way round
`curves`       legs as curves that leave and arrive at their headings
`equations`    sparse systems over points in the plane
=============  ==================================================================================================

A picture is (n, 2) points. Once its faces are cut into triangles inside a convex frame and every triangle is
counter-clockwise, it is plane, with the rotation and the outer face of the map: that is what untangling works towards,
and what no later step may undo. Nothing here is trusted: the layouts check what they return
(`ninefold.layout.planarity`).
"""
