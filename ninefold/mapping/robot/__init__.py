"""How a robot builds a map: what it senses, what it remembers, and the map that grows with every event.

=============  ==================================================================================================
`walk`         `Walk`: visits to places and the heading samples between them, as they come
`legs`         what the samples of one leg say: heading on leaving, heading on arriving, net rotation
`mapper`       `Mapper`: one event after another becomes a plane map that is valid at every moment
`open_map`     `OpenMap`: what a robot knows while it explores, with the exits that nobody has walked
`strategies`   `Strategy`, and three that walk everything: where to go next, from what is known
`simulated`    `SimulatedWorld`, `explore`: a robot that walks through a source with geometry
=============  ==================================================================================================

`Memory` (in ``_memory``) holds the places with their stars of known darts (``_star``) and the growing map (``_growing``),
whose faces are split as edges close them. Reading a leg is apart from recognising the place at its end, because walks whose
places are in doubt need the legs alone. The public names are those of `ninefold.mapping`.
"""
