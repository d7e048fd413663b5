"""Relations on drawings from headings, and on relaxed ones, equal those that shapely computes."""

import pytest

from ninefold.io import samples
from ninefold.layout import verify


@pytest.mark.parametrize("layout", ["compass", "relaxed"])
def test_the_district_agrees(layout):
    report = verify(samples.load("helsinki_district").to_map(), n_pairs=3000, seed=5, layout=layout)
    assert report.agree, str(report)
    assert (report.pairs, report.layout) == (3000, layout)
