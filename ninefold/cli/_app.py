"""The typer application: which command lives in which module."""

import typer

from ninefold import __version__

from . import atlas, claims, demo, explore, hypotheses, locate, networks, pictures, relate

__all__ = ["app"]

# In the order of the help text: function, name, and what it does in a few words.
_COMMANDS = (
    (demo.demo, "demo", "Walk, map and compare real streets, end to end."),
    (explore.explore, "explore", "Let a simulated robot explore a world and log its walk."),
    (atlas.map_source, "map", "Build a map from a walk log or from geometry."),
    (atlas.info, "info", "Show what an atlas holds."),
    (atlas.name, "name", "Give a place, path or region a name."),
    (relate.relate, "relate", "Tell how two sets lie to each other, or all of them."),
    (pictures.draw, "draw", "Draw the map."),
    (pictures.verify, "verify", "Check a map and its relations on a drawing."),
    (locate.locate, "locate", "Where can a robot be whose walk began anywhere?"),
    (hypotheses.hypotheses, "hypotheses", "Every plane map that explains a walk whose places look alike."),
    (claims.claims, "claims", "Which loop closures of a pose graph cannot be right?"),
    (networks.check, "check", "Can declared relations all be true?"),
    (networks.prove, "prove", "Confirm a proof that they cannot."),
    (networks.infer, "infer", "Which relations are possible between two things?"),
    (networks.ask, "ask", "Does a formula follow, is it possible, or not?"),
    (networks.repair, "repair", "The cheapest statements to drop so that the rest can be true."),
    (networks.scenarios, "scenarios", "List the ways in which all can be true."),
    (networks.compose, "compose", "What x R y and y S z leave between x and z."),
)

# Plain help text: loading rich would cost more than everything else that `--help` does.
app = typer.Typer(
    name="ninefold",
    help="Plane maps a robot builds from places and headings alone, and exact topological relations on them.",
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 110},
)


def _show_version(asked: bool) -> None:  # noqa: FBT001 - the signature typer asks for
    if asked:
        typer.echo(f"ninefold {__version__}")
        raise typer.Exit


@app.callback()
def _options(
    *,
    version: bool = typer.Option(
        False, "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
    ),
) -> None:
    pass


for _function, _name, _summary in _COMMANDS:
    app.command(_name, short_help=_summary)(_function)
