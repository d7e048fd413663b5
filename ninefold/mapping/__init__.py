"""mapping."""
from .plane import PlaneMap
from .heading import Heading
