"""No test depends on how fast the machine is: Hypothesis sets no deadline unless a test asks for one."""

from hypothesis import settings

settings.register_profile("ninefold", deadline=None)
settings.load_profile("ninefold")
