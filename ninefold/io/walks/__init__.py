"""Walk logs: `json_lines` reads and writes them, `streams` takes them from a pipe, `mapped` makes their maps.

`heading_units` doubts headings that look like another unit.
"""
