"""Columns of the engine's integer tables, and the words it answers with.

A compiled kernel cannot hold objects, so the state of a search is a handful of two-dimensional arrays whose columns are
named here. Rows that are read together lie together, which is also what the cache wants.
"""

from __future__ import annotations

# edges (E + b + 1 rows, the last ones head the queue's buckets): what propagation needs of a pair that is kept
TAIL = 0  # smaller node of the pair
HEAD = 1  # larger node
LAST = 2  # last trail entry that changed the pair, or -1
AHEAD = 3  # next pair in the queue's bucket
BEHIND = 4  # previous pair in the queue's bucket
BUCKET = 5  # size under which the pair is queued, or 0
WATCH = 6  # first watch node of clauses that watch the pair, or -1
EDGE_COLUMNS = 8  # 32 bytes

# marks (E rows): what learning and splitting need of a pair
NEED = 0  # mask the conflict under analysis needs of the pair (all ones: nothing)
AT = 1  # trail entry that made NEED true
HELD = 2  # 1 while the pair is in the list of premises
ROOT = 3  # relation at level 0
LABEL = 4  # stated relation, or -1 for a pair that is only derived
MARK_COLUMNS = 5

# nodes (n + 1 rows)
FIRST = 0  # first edge whose TAIL is this node
ROOM = 1  # where the node's partners start in `active`
BUSY = 2  # number of them
NODE_COLUMNS = 3

# trail: one narrowing of one pair
EDGE = 0
OLD = 1
NEW = 2
WHY = 3  # first arc of the triangle; or DECIDED or CLAUSE
OTHER = 4  # second arc of the triangle, or the clause
PREV = 5  # entry that changed the pair before, or -1
DEPTH = 6  # decision level
TRAIL_COLUMNS = 7
DECIDED = -1
CLAUSE = -2

# watch: node 2c + s watches literal s of clause c
NEXT = 0
MASK = 1
BLOCK_EDGE = 2
BLOCK_MASK = 3
WATCH_COLUMNS = 4

# arena: a clause is SIZE, LBD, then (edge, mask) pairs
SIZE = 0
LBD = 1
LITERALS = 2

# registers
TOP = 0  # entries on the trail
LEVEL = 1  # decision level
SEEN = 2  # trail entries whose clauses have been visited
N_CLAUSES = 3
ARENA_TOP = 4
LOG_TOP = 5
CONFLICTS = 6
DECISIONS = 7
SINCE_RESTART = 8
RESTARTS = 9
REDUCE_AT = 10  # conflicts at which clauses are cleaned up next
TROUBLE = 11  # kind of the conflict found: 0 none, 1 triangle, 2 clause
TROUBLE_A = 12  # arc left empty, or the clause
TROUBLE_F = 13
TROUBLE_G = 14
TICKS = 15  # elementary steps done
N_HELD = 16
KEEP = 17  # 1 when narrowings are written to the trail
CORE = 18  # first node of the complete part of the graph, which has bit-planes
N_EDGES = 19
N_NODES = 20
FULL = 21  # mask of the universal relation
N_BASES = 22
CURSOR = 23  # every stated pair before this place is settled
LOGGING = 24
NARROWED = 25  # narrowings so far
CHECKED = 26  # NARROWED when every pair was queued for the last check, or -1
N_RECENT = 27  # pairs written to the ring of recent ones
RING = 28  # 1 when `recent` is a ring, 0 when it lists all stated pairs
N_REGISTERS = 29

NO_TROUBLE = 0
TRIANGLE_TROUBLE = 1
CLAUSE_TROUBLE = 2

# answers of the search kernel
CONSISTENT = 1
INCONSISTENT = 2
PAUSED = 3
TRAIL_FULL = 4
ARENA_FULL = 5
LOG_FULL = 6
REDUCE = 7
FIXPOINT = 8
CONFLICT = 9
