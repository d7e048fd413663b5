"""The atlas: one SQLite file with a walk, its map, named sets, declared relations and where they came from.

=================  ==============================================================================================
`atlas`            `Atlas`: open, append events, store and read sets and statements
`feed`             `Feed`: lines of a walk that is still going on, each event on disk before the next
`guess`            `Guess`, what is in doubt about a map that is the likeliest of several
`records`          `Provenance` and `Statement`, what is kept beside the map
``_file``          one connection and its transactions; ``_schema`` the tables and what an open file is checked for
``_event_log``     the walk as an append-only log, and snapshots of the map
``_map_rows``      a map as rows of blobs and names
``_definitions``   sets as what defines them, never as face numbers
=================  ==============================================================================================

The tables are documented in the reference; any SQLite tool reads them.
"""
