"""The mesh that pictures are untangled in is the same, whichever form its kernels run in."""

import numpy as np

from ninefold.io import samples
from ninefold.layout.shaping.directions import shape_of_directions
from ninefold.layout.shaping.mesh import Mesh, cut_faces
from ninefold.layout.shaping.pieces import pieces_of, spread


def test_faces_are_cut_alike_plain_and_compiled(monkeypatch):
    pieces = spread(pieces_of(samples.load("garden").to_map()))
    shape = shape_of_directions(pieces)
    meshes = []
    for form in (cut_faces.plain, cut_faces.compiled):
        monkeypatch.setattr(cut_faces, "for_work", lambda _, form=form: form)
        meshes.append(Mesh(pieces, shape))
    assert meshes[0].forced == meshes[1].forced
    assert np.array_equal(meshes[0].triangles, meshes[1].triangles)
    assert len(meshes[0].triangles) > 10
