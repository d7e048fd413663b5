"""Where a robot can be: an exact belief over the places of a map, from noisy headings.

=============  ==================================================================================================
`localizer`    `Localizer`: what is seen and walked, one thing after another, narrows where the robot can be
`following`    `locate`, `Follower`: a localizer taken along a walk, event by event
`noise`        how much headings are declared to err
=============  ==================================================================================================

`Stars` (in ``_stars``) holds the exits of every place by heading; ``_matching`` weighs all ways in which the exits seen can
be those of a place; ``_ahead``
looks where to go. The public names are those of `ninefold.mapping`.
"""
