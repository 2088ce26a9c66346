"""Annotations of a field besides its type: the names it takes, its form, its conversion.

    best: Annotated[str, OneOf(LINKS)]
    scale: Annotated[float, Gt(0)]
    edges: Annotated[tuple[str, ...], MinLen(1)]

Ranges and lengths are those of ``annotated_types``. pydantic reads them all, for a file's values and for its JSON
Schema; none of them imports pydantic before a file is read, since that takes a tenth of a second.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, get_args, get_type_hints

from annotated_types import Ge, Le

from automotive_cosim.contracts import Json

if TYPE_CHECKING:
    from pydantic import GetCoreSchemaHandler, GetJsonSchemaHandler
    from pydantic_core.core_schema import CoreSchema


@dataclass(frozen=True, slots=True, eq=False)
class OneOf:
    """A text that is one of some names; for an enumeration, it becomes the member."""

    names: Iterable[str]
    what: str = ""
    """What the names stand for, e.g. ``"road user"``; empty: the field's name."""
    beside: str = ""
    """Pattern of further texts that are valid, anchored; the enumeration knows them too."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        names: CoreSchema = core_schema.literal_schema([str(name) for name in self.names])
        if self.beside:
            names = core_schema.union_schema([names, core_schema.str_schema(pattern=self.beside, strict=True)])
        if isinstance(self.names, type):
            return core_schema.no_info_after_validator_function(self.names, names)
        return names

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> Json:
        return handler(schema) | ({"title": self.what} if self.what else {})


@dataclass(frozen=True, slots=True, eq=False)
class Form:
    """A text of a certain form."""

    pattern: str
    """Regular expression without look-around, anchored."""
    example: str
    read: Callable[[str], Any] = str
    """Converts the text; the message of a ValueError is shown to the user."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_after_validator_function(
            self.read, core_schema.str_schema(pattern=self.pattern, strict=True)
        )

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> Json:
        return handler(schema) | {"examples": [self.example]}


@dataclass(frozen=True, slots=True, eq=False)
class Made:
    """A value that is written as another type."""

    of: Any
    """The type in the file."""
    by: Callable[[Any], Any]
    """Converts it to the value; the message of a ValueError is shown to the user."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        return core_schema.no_info_after_validator_function(self.by, handler.generate_schema(self.of))


@dataclass(frozen=True, slots=True, eq=False)
class Called:
    """What a value must be, in the field's own words: "a list of [lon, lat] corners"."""

    words: str

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> Json:
        return handler(schema) | {"title": self.words}


@dataclass(frozen=True, slots=True, eq=False)
class TaggedBy:
    """A union whose members are distinguished by a field, each with its own ``Literal``."""

    field: str

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic import Discriminator

        return handler(Annotated[source, Discriminator(self.field)])


@dataclass(frozen=True, slots=True, eq=False)
class Chosen:
    """A union whose member is chosen by looking at a table."""

    by: Callable[[Mapping[str, Any]], type]

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        from pydantic_core import core_schema

        members = {member.__name__: handler.generate_schema(member) for member in get_args(source)}

        def choose(value: Any) -> str:
            return (self.by(value) if isinstance(value, Mapping) else get_args(source)[0]).__name__

        return core_schema.tagged_union_schema(members, choose)


@dataclass(frozen=True, slots=True, eq=False)
class Option:
    """How a field is given on the command line, where that does not follow from its name, type and default."""

    name: str = ""
    """Without the dashes; empty: the field's name, without its unit."""
    default: str = ""
    """What the help shows as the default; empty: the field's default."""
    form: str = ""
    """What the help shows for its value; empty: what the type says."""
    read: Callable[[str], Any] | None = None
    """Turns what was given into the value; None: as the type says."""
    panel: str | None = None
    """Heading of the help below which it stands."""
    repeats: bool = False
    """Whether the option is given once for each item of a list, which may contain commas."""
    variable: str | None = None
    """The environment variable that gives it otherwise."""


Longitude = Annotated[float, Ge(-180), Le(180), Called("a longitude from -180 (west) to 180 (east)")]
Latitude = Annotated[float, Ge(-90), Le(90), Called("a latitude from -90 (south) to 90 (north)")]


UNIT = "_s"
"""The unit that the name of a field has, but not that of its option: the help says it."""
PLAIN = Option()


def option(kind: type, field: str) -> str:
    """The option of a field, such as ``--warm-up`` of ``warm_up_s``."""
    return f"--{option_name(field, get_type_hints(kind, include_extras=True)[field])}"


def option_name(field: str, hint: Any) -> str:
    """The same without the dashes, of a field with this annotation."""
    return shown_as(hint).name or field.removesuffix(UNIT).replace("_", "-")


def shown_as(hint: Any) -> Option:
    """What an annotation says about the option."""
    return next((each for each in getattr(hint, "__metadata__", ()) if isinstance(each, Option)), PLAIN)
