"""Draws each widget, in the day or night palette."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image

from automotive_cosim.cockpit.camera import camera
from automotive_cosim.cockpit.carview import car
from automotive_cosim.cockpit.covers import cover
from automotive_cosim.cockpit.drawing import Canvas, fits, text_width
from automotive_cosim.cockpit.geometry import Rect
from automotive_cosim.cockpit.mapdraw import draw
from automotive_cosim.cockpit.photos import photo
from automotive_cosim.cockpit.telltales import SignKind, colour, sign_picture, symbol
from automotive_cosim.cockpit.theme import Colour, Icon, Palette, Type
from automotive_cosim.cockpit.widgets import (
    Badge,
    Bar,
    Button,
    CameraView,
    Card,
    CarView,
    Choice,
    Cover,
    Field,
    Glyph,
    Label,
    LimitSign,
    Look,
    MapView,
    Picture,
    Pill,
    Row,
    Rows,
    Screen,
    SignView,
    Slider,
    Telltales,
    Tile,
    Widget,
)
from automotive_cosim.contracts import Severity

NARROW = 150
"""Tiles narrower than this stack icon and text."""
TALL = 110
"""Stacked choices this high have large icons."""
ROOMY = 230
"""Low tiles narrower than this have a light where name and toggle do not fit."""
SPILL = 4
"""How far letters and icons may extend out of their box, in logical pixels."""
WORTH_IT = 0.7
"""Above this share of changes, everything is redrawn."""
TELLTALE, TELLTALE_GAP = 28, 3
LOW = 76
"""Tiles lower than this put icon and text on one line."""


def render(screen: Screen, scale: float = 1.0) -> Canvas:
    """Draws the tree, with ``scale`` pixels per logical pixel."""
    palette = screen.palette
    _, _, width, height = screen.rect.edges(scale)
    canvas = Canvas.plain(width, height, scale, palette.background, screen.style, night=screen.night)
    canvas.box(screen.dock, palette.surface)
    _children(canvas, screen, palette)
    return canvas


def repaint(before: Screen, pixels: npt.NDArray[np.uint8], screen: Screen) -> tuple[Image.Image, tuple[Rect, ...]]:
    """Draws the tree on the picture of another, (height, width, 3), RGB, only where they differ.

    Returns:
        The same picture as from ``render``, and the boxes that were redrawn."""
    gone = [widget for widget in before.children if widget not in screen.children]
    come = [widget for widget in screen.children if widget not in before.children]
    reaches = [(widget, _reach(widget, screen)) for widget in screen.children]
    boxes = _grown([_reach(widget, screen) for widget in (*gone, *come)], [reach for _, reach in reaches])
    scale = pixels.shape[1] / screen.rect.width
    worth_it = WORTH_IT * screen.rect.width * screen.rect.height
    if before.night is not screen.night or sum(box.width * box.height for box in boxes) > worth_it:
        return render(screen, scale).image, (screen.rect,)
    palette = screen.palette
    canvas = Canvas(Image.fromarray(pixels), scale, screen.style, night=screen.night)
    for box in boxes:
        canvas.box(box, palette.background)
        if box.overlaps(screen.dock):
            canvas.box(box.within(screen.dock), palette.surface)
    for widget, reach in reaches:
        if any(reach.overlaps(box) for box in boxes):
            _PAINT[type(widget)](canvas, widget, palette)
            _children(canvas, widget, palette)
    return canvas.image, boxes


def _reach(widget: Widget, screen: Screen) -> Rect:
    """The part of the screen that drawing the widget may touch."""
    return widget.rect.inset(-SPILL).within(screen.rect)


def _grown(boxes: list[Rect], reaches: list[Rect]) -> tuple[Rect, ...]:
    """The boxes, extended to whole widgets: a widget is redrawn completely or not at all."""
    boxes = list(dict.fromkeys(boxes))
    for box in boxes:
        boxes += [reach for reach in reaches if reach.overlaps(box) and reach not in boxes]
    return tuple(boxes)


def _children(canvas: Canvas, widget: Widget, palette: Palette) -> None:
    for child in widget.children:
        _PAINT[type(child)](canvas, child, palette)
        _children(canvas, child, palette)


def _card(canvas: Canvas, card: Card, palette: Palette) -> None:
    if card.look == "surface":
        canvas.box(card.rect, palette.surface, canvas.style.card)
    elif card.look == "raised":
        canvas.box(card.rect, palette.raised, canvas.style.button + 4)
    elif card.look == "plate":
        canvas.box(card.rect, palette.plate, canvas.style.card)


def _label(canvas: Canvas, label: Label, palette: Palette) -> None:
    if label.plate:
        canvas.box(label.rect, palette.plate, 8)
    tone: Colour = getattr(palette, label.tone)
    canvas.text(label.rect, label.text, label.style, tone, label.align, label.lines, keeps_end=label.keeps_end)


def _glyph(canvas: Canvas, glyph: Glyph, palette: Palette) -> None:
    canvas.icon(glyph.rect.centre, glyph.icon, glyph.size, getattr(palette, glyph.tone))


def _button(canvas: Canvas, button: Button, palette: Palette) -> None:
    fill, ink = {
        Look.PLAIN: (None, palette.text),
        Look.TONAL: (palette.raised, palette.text),
        Look.FLOATING: (palette.plate, palette.text),
        Look.ACCENT: (palette.accent, palette.on_accent),
        Look.CRITICAL: (palette.critical, palette.on_critical),
    }[button.look]
    icon = Icon.LOCK if button.locked and button.icon is not None else button.icon
    if not button.usable:
        fill, ink = palette.raised, palette.disabled
    if fill is not None:
        whole = button.look is Look.ACCENT and not button.text
        canvas.box(button.rect, fill, button.rect.height if whole else canvas.style.button)
    _content(canvas, button.rect, icon, button.icon_size, button.text, button.style, ink, button.stacked)


def _choice(canvas: Canvas, choice: Choice, palette: Palette) -> None:
    ink = palette.text
    if choice.selected:
        canvas.box(choice.rect, palette.tint, canvas.style.button)
        ink = palette.on_tint
    elif choice.look == "quiet":
        ink = palette.muted
    elif choice.look == "boxed":
        canvas.box(choice.rect, palette.raised, canvas.style.button)
    if not choice.usable:
        ink = palette.on_tint if choice.selected else palette.disabled
    _content(
        canvas,
        choice.rect,
        Icon.LOCK if choice.locked else choice.icon,
        _choice_icon(choice),
        choice.text,
        choice.style,
        ink,
        choice.stacked,
    )


def _choice_icon(choice: Choice) -> int:
    if not choice.stacked:
        return 26
    return 44 if choice.rect.height >= TALL else 30


def _content(
    canvas: Canvas, rect: Rect, icon: Icon | None, size: int, text: str, style: Type, ink: Colour, stacked: bool
) -> None:
    """An icon, a text or both, in the middle of a box."""
    if icon is None or not text:
        if icon is not None:
            canvas.icon(rect.centre, icon, size, ink)
        canvas.text(rect.inset(8, 0), text, style, ink, "centre")
        return
    if stacked:
        gap = 8
        tall = size + gap + round(style.size * 1.2)
        top = rect.y + (rect.height - tall) // 2
        canvas.icon((rect.centre[0], top + size // 2), icon, size, ink)
        line = Rect(rect.x + 4, top + size + gap, rect.width - 8, round(style.size * 1.2))
        canvas.text(line, text, style, ink, "centre")
        return
    room = rect.width - 20 - size - 10
    wide = min(room, round(text_width(text, style)) + 1)
    left = rect.x + (rect.width - size - 10 - wide) // 2
    canvas.icon((left + size // 2, rect.centre[1]), icon, size, ink)
    canvas.text(Rect(left + size + 10, rect.y, wide, rect.height), text, style, ink)


def _tile(canvas: Canvas, tile: Tile, palette: Palette) -> None:
    fill, ink, mark = palette.raised, palette.text, palette.muted
    if tile.checked:
        fill, ink, mark = palette.tint, palette.on_tint, palette.on_tint
    rect = tile.rect
    canvas.box(rect, fill, canvas.style.button)
    if tile.locked:
        ink = mark = palette.disabled
    if tile.text and rect.height < LOW:
        _line_tile(canvas, tile, ink, mark, palette)
        return
    if not tile.text or rect.width < NARROW:
        _content(canvas, rect, tile.icon, 32, tile.text, Type.LABEL, ink, stacked=True)
        _lit(canvas, rect, tile.checked, palette)
        return
    upper = rect.y + 18 + (rect.height - 88) // 3 + 14
    canvas.icon((rect.x + 34, upper), tile.icon, 32, ink)
    canvas.text(Rect(rect.x + 18, rect.bottom - 40, rect.width - 30, 28), tile.text, Type.LABEL, ink)
    if tile.level:
        canvas.text(Rect(rect.x + 70, upper - 14, rect.width - 88, 28), tile.level, Type.LABEL, mark, "right")
    else:
        _toggle(canvas, Rect(rect.right - 60, upper - 12, 44, 24), tile.checked, palette)


def _line_tile(canvas: Canvas, tile: Tile, ink: Colour, mark: Colour, palette: Palette) -> None:
    """Icon, name and state side by side."""
    rect = tile.rect
    canvas.icon((rect.x + 28, rect.centre[1]), tile.icon, 28, ink)
    if tile.level:
        wide = round(text_width(tile.level, Type.LABEL)) + 2
        canvas.text(Rect(rect.right - 16 - wide, rect.y, wide, rect.height), tile.level, Type.LABEL, mark, "right")
    elif tile.locked:
        wide = 28
        canvas.icon((rect.right - 30, rect.centre[1]), Icon.LOCK, 24, mark)
    elif rect.width < ROOMY and 50 + text_width(tile.text, Type.LABEL) + 64 > rect.width:
        wide = 0
        _lit(canvas, rect, tile.checked, palette)
    else:
        wide = 44
        _toggle(canvas, Rect(rect.right - 58, rect.centre[1] - 12, 44, 24), tile.checked, palette)
    words = Rect(rect.x + 50, rect.y, rect.width - 50 - wide - 20, rect.height)
    canvas.text(words, tile.text, Type.LABEL, ink)


def _lit(canvas: Canvas, rect: Rect, on: bool, palette: Palette) -> None:
    """The light of a switch that is too small for a toggle."""
    canvas.box(Rect(rect.centre[0] - 10, rect.bottom - 8, 20, 4), palette.accent if on else palette.pressed, 2)


def _toggle(canvas: Canvas, rect: Rect, on: bool, palette: Palette) -> None:
    canvas.box(rect, palette.accent if on else palette.pressed, 12)
    side = rect.height - 6
    knob = Rect(rect.right - 3 - side if on else rect.x + 3, rect.y + 3, side, side)
    canvas.disc(knob, palette.on_accent if on else palette.muted)


def _slider(canvas: Canvas, slider: Slider, palette: Palette) -> None:
    rect, track = slider.rect, slider.track
    line = Rect(rect.x, rect.y, rect.width, rect.height - 40)
    left = rect.x
    if slider.icon is not None:
        canvas.icon((rect.x + 14, line.centre[1]), slider.icon, 26, palette.muted)
        left += 40
    wide = max(90, round(text_width(slider.text, Type.STRONG)) + 2)
    name = Rect(left, line.y, min(200, line.right - wide - left), line.height)
    canvas.text(name, slider.description, Type.LABEL, palette.muted)
    canvas.text(line.right_part(wide), slider.text, Type.STRONG, palette.text, "right")
    canvas.box(track, palette.pressed, 4)
    low, high = slider.signal.low, slider.signal.high
    done = round(track.width * (slider.value - low) / (high - low))
    canvas.box(track.left(max(done, 8)), palette.accent, 4)
    knob = Rect(track.x + done - 15, track.y + 4 - 15, 30, 30)
    canvas.disc(knob, palette.accent)
    canvas.disc(knob.inset(8), palette.on_accent)


def _field(canvas: Canvas, field: Field, palette: Palette) -> None:
    outline = palette.accent if field.focused else None
    canvas.box(field.rect, palette.surface, canvas.style.button, outline)
    x, y = field.rect.x + 34, field.rect.centre[1]
    canvas.icon((x, y), field.icon, 28, palette.muted)
    words = Rect(field.rect.x + 64, field.rect.y, field.rect.width - 120, field.rect.height)
    shown, ink = (field.text, palette.text) if field.text else (field.hint, palette.muted)
    if field.locked:
        ink = palette.disabled
        canvas.icon((field.rect.right - 34, y), Icon.LOCK, 24, palette.disabled)
    canvas.text(words, shown, Type.BODY, ink)


def _row(canvas: Canvas, row: Row, palette: Palette) -> None:
    rect = row.rect
    fill, ink, detail = palette.surface, palette.text, palette.muted
    if row.selected:
        fill, ink, detail = palette.tint, palette.on_tint, palette.on_tint
    elif row.on_tap is None or row.raised:
        fill = palette.raised
    if not row.usable:
        ink = detail = palette.disabled
    canvas.box(rect, fill, canvas.style.button)
    left, right = rect.x + 18, rect.right - 14
    if row.icon is not None:
        tint = ink if row.selected or not row.usable else getattr(palette, row.tone)
        canvas.icon((left + 12, rect.centre[1]), row.icon, 26, tint)
        left += 42
    if row.locked:
        canvas.icon((right - 14, rect.centre[1]), Icon.LOCK, 24, ink)
        right -= 38
    words = Rect(left, rect.y, right - left, rect.height)
    wide = round(text_width(row.trail, Type.CAPTION)) + 2 if row.trail else 0
    room = words.width - (wide + 12 if row.trail else 0)
    tall, low = _shares(row, room, words.width) if rect.height < 80 else (26, 0)
    top = (rect.height - tall - low - 2) // 2 if rect.height < 80 else 8
    upper = Rect(words.x, rect.y + top, words.width, tall) if row.detail else words
    if row.trail:
        canvas.text(upper.right_part(wide), row.trail, Type.CAPTION, detail, "right")
    canvas.text(upper.left(room), row.text, Type.LABEL, ink)
    if not row.detail:
        return
    if rect.height < 80:
        canvas.text(Rect(words.x, rect.y + top + tall + 1, words.width, low), row.detail, Type.CAPTION, detail)
    else:
        canvas.text(words.below(36).top(rect.height - 36 - 6), row.detail, Type.CAPTION, detail, lines=2)


def _shares(row: Row, room: int, width: int) -> tuple[int, int]:
    """Heights of a row's text and detail: the one that is too long for a line gets two."""
    if not fits(row.text, Type.LABEL, room):
        return 38, 20
    return (26, 24) if fits(row.detail, Type.CAPTION, width) else (21, 37)


def _rows(canvas: Canvas, rows: Rows, palette: Palette) -> None:
    if rows.total <= rows.shown:
        return
    rail = Rect(rows.rect.right - 6, rows.rect.y, 6, rows.rect.height)
    canvas.box(rail, palette.raised, 3)
    size = max(24, rail.height * rows.shown // rows.total)
    start = (rail.height - size) * rows.first // rows.last_first
    canvas.box(Rect(rail.x, rail.y + start, 6, size), palette.muted, 3)


def _bar(canvas: Canvas, bar: Bar, palette: Palette) -> None:
    rect = bar.rect
    canvas.box(rect, palette.pressed, rect.height // 2)
    if bar.share > 0:
        done = max(rect.height, round(rect.width * min(1.0, bar.share)))
        canvas.box(rect.left(done), getattr(palette, bar.tone), rect.height // 2)


def _sign(canvas: Canvas, sign: LimitSign, palette: Palette) -> None:
    side = canvas.pixels_across(sign.rect)
    _stand(canvas, sign.rect, sign_picture(SignKind.LIMIT, sign.text, side, sign.country))


def _telltales(canvas: Canvas, row: Telltales, palette: Palette) -> None:
    side, step = TELLTALE, TELLTALE + TELLTALE_GAP
    across, lines = ((length + TELLTALE_GAP) // step for length in (row.rect.width, row.rect.height))
    for at, telltale in enumerate(row.lit[: across * lines]):
        line, column = divmod(at, across)
        box = Rect(row.rect.x + column * step, row.rect.y + line * step, side, side)
        canvas.stencil(box, symbol(telltale, canvas.pixels_across(box)), colour(telltale, night=canvas.night))


def _sign_view(canvas: Canvas, view: SignView, palette: Palette) -> None:
    if view.sign is None:
        return
    side = canvas.pixels_across(view.rect)
    _stand(canvas, view.rect, sign_picture(view.sign.kind, view.figure, side, view.sign.country))


def _stand(canvas: Canvas, rect: Rect, sign: Image.Image) -> None:
    canvas.stencil(rect, sign.getchannel("A"), sign.convert("RGB"))


def _cover(canvas: Canvas, view: Cover, palette: Palette) -> None:
    canvas.picture(view.rect, cover(view.name, canvas.pixels_across(view.rect)), canvas.style.button)


def _camera(canvas: Canvas, view: CameraView, palette: Palette) -> None:
    left, top, right, bottom = view.rect.edges(canvas.scale)
    canvas.picture(view.rect, camera(view.scene, right - left, bottom - top), canvas.style.card)


def _pill(canvas: Canvas, pill: Pill, palette: Palette) -> None:
    fill, ink = {
        Severity.INFO: (palette.tint, palette.on_tint),
        Severity.WARNING: (palette.warning, palette.on_warning),
        Severity.CRITICAL: (palette.critical, palette.on_critical),
    }[pill.severity]
    rect = pill.rect
    canvas.box(rect, fill, 26)
    canvas.icon((rect.x + 32, rect.centre[1]), pill.icon, 30, ink)
    words = Rect(rect.x + 60, rect.y, rect.width - 80, rect.height)
    canvas.text(words, pill.text, Type.LABEL, ink, lines=2)


def _map(canvas: Canvas, view: MapView, palette: Palette) -> None:
    rect = view.rect
    size = round(rect.width * canvas.scale), round(rect.height * canvas.scale)
    canvas.picture(rect, draw(view.roads, view.scene, *size, canvas.scale, palette), canvas.style.card)


def _badge(canvas: Canvas, badge: Badge, palette: Palette) -> None:
    ground, ink = (palette.warning, palette.on_warning) if badge.warns else (palette.plate, palette.text)
    if badge.charges:
        ground, ink = palette.good, palette.plate
    canvas.disc(badge.rect, palette.casing)
    canvas.disc(badge.rect.inset(2), ground)
    canvas.icon(badge.rect.centre, badge.icon, round(0.65 * badge.rect.width), ink)


def _car_view(canvas: Canvas, view: CarView, palette: Palette) -> None:
    lamps = (view.position, view.low, view.high, view.front_fog, view.rear_fog, view.hazard)
    size = round(view.rect.width * canvas.scale), round(view.rect.height * canvas.scale)
    picture = car(*size, lamps, view.windshield, view.rear_window, palette, night=canvas.night)
    canvas.picture(view.rect, picture)


def _picture(canvas: Canvas, picture: Picture, palette: Palette) -> None:
    left, top, right, bottom = picture.rect.edges(canvas.scale)
    canvas.picture(picture.rect, photo(picture.photo, right - left, bottom - top), canvas.style.button)


_PAINT: dict[type[Widget], Callable[[Canvas, Any, Palette], None]] = {
    Card: _card,
    Label: _label,
    Glyph: _glyph,
    Button: _button,
    Choice: _choice,
    Tile: _tile,
    Slider: _slider,
    Field: _field,
    Row: _row,
    Rows: _rows,
    Bar: _bar,
    LimitSign: _sign,
    Pill: _pill,
    Telltales: _telltales,
    SignView: _sign_view,
    Cover: _cover,
    CameraView: _camera,
    MapView: _map,
    Badge: _badge,
    CarView: _car_view,
    Picture: _picture,
}
"""The drawing function of each kind of widget."""
