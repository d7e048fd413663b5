"""The typer application: which command lives in which module."""

import typer

from ninefold import __version__

from . import atlas, demo, explore, networks, pictures, relate

__all__ = ["app"]

# In the order of the help text: function, name, and what it does in a few words.
_COMMANDS = (
    (demo.demo, "demo", "The main job on real streets, end to end."),
    (explore.explore, "explore", "Simulate a robot's exploration of a source with geometry."),
    (atlas.map_source, "map", "Build the atlas of a walk, or of a source with geometry."),
    (atlas.info, "info", "Show what an atlas holds."),
    (atlas.name, "name", "Store a named set."),
    (relate.relate, "relate", "One relation, or a table of all."),
    (pictures.draw, "draw", "Draw the map."),
    (pictures.verify, "verify", "Hold symbolic answers against geometry."),
    (networks.check, "check", "Is a relation network consistent?"),
    (networks.prove, "prove", "Confirm a proof of inconsistency."),
    (networks.infer, "infer", "Which relations are feasible between two entities?"),
    (networks.ask, "ask", "Is a formula entailed, possible or impossible?"),
    (networks.repair, "repair", "The cheapest statements to drop."),
    (networks.scenarios, "scenarios", "The scenarios of a network, one after another."),
    (networks.compose, "compose", "Compose two relations."),
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
