"""From pictures of a bench to where its components stand."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import replace

from pico.model.catalog import MarkerPlate
from pico.model.observation import Uncertainty
from pico.model.pose import Pose
from pico.model.setup import Setup
from pico.vision.calibration import Calibration
from pico.vision.datums import check
from pico.vision.judge import Verdict, combined, judged
from pico.vision.markers import Markers, read_marker
from pico.vision.poses import MarkerView, edge, flat_start, from_rays, meet, plane_points, triangulated
from pico.vision.rigid import planar
from pico.vision.sighting import CameraMoved, Finding, SeenPart, Sighting, Stranger

_HEIGHT, _SIZE = 140.0, 24.0  # mm, of a marker that nothing is known about
_NEAR = 20.0  # mm: closer than this, what two cameras see is one thing


def replace_dark(sighting: Sighting, dark: tuple[str, ...]) -> Sighting:
    """Return a sighting that also says which cameras delivered black pictures."""
    found = tuple(Finding(kind="dark", text=f"the picture of camera `{name}` is black") for name in dark)
    return replace(sighting, dark=dark, findings=(*found, *sighting.findings)) if dark else sighting


def recognize(
    setup: Setup, pictures: Sequence[Markers], calibration: Calibration, held: Collection[str] = ()
) -> Sighting:
    """Return where the components stand whose markers `pictures` show, one picture a camera, and what was wrong.

    `calibration`: its cameras stand in the table's frame (`Calibration.placed` for the eye of a robot). `held`: what
    robots hold, which is not where it stands.

    Never a wrong identity: a part has a pose only where its number was read in full, once, and stands upright at the
    height that its type has. Two plates of one size at one height that were swapped by hand can't be told by any
    picture: the number is then what says which part it is.
    """
    parts = _parts(setup)
    datums = {datum.marker for datum in setup.lab.datums.values()}
    views = _views(pictures, calibration)
    twice = frozenset().union(*(picture.duplicates for picture in pictures)) - datums
    findings = [_duplicate(setup, number, views[number], parts) for number in sorted(twice)]
    components: dict[str, SeenPart] = {}
    toppled: list[str] = []
    for number, (name, plate) in sorted(parts.items()):
        if number not in views or number in twice or name in held:
            continue
        chosen, in_hand = _preferred(setup, views[number])
        verdict = judged(chosen, plate, calibration.accuracy, in_hand)
        if verdict.kind:
            findings.append(_finding(name, number, chosen, plate, verdict))
        if verdict.kind == "tilted":
            toppled.append(name)
        if verdict.estimate is not None:
            components[name] = _seen(verdict, plate, chosen, calibration)
    strangers = _strangers(setup, views, twice | datums | parts.keys(), calibration)
    findings += [_stranger(stranger) for stranger in strangers.values()]
    findings += _half_seen(setup, pictures, calibration, components, strangers)
    if any(not _rides(setup, picture.camera) for picture in pictures):
        findings += _hidden(parts, views, held)
    drift, checked, loose = _drift(setup, pictures, calibration)
    return Sighting(
        components=components,
        unknown=strangers,
        toppled=tuple(toppled),
        findings=(*loose, *findings),
        drift=drift,
        checked=checked,
    )


def _parts(setup: Setup) -> dict[int, tuple[str, MarkerPlate]]:
    """Return the components that can be seen, by the number of their marker."""
    return {
        part.marker: (name, plate)
        for name, part in setup.lab.inventory.items()
        if part.marker is not None and (plate := setup.type_of(name).geometry.marker) is not None
    }


def _rides(setup: Setup, camera: str) -> bool:
    return camera in setup.lab.cameras and setup.lab.cameras[camera].robot is not None


def _views(pictures: Iterable[Markers], calibration: Calibration) -> dict[int, list[MarkerView]]:
    views: dict[int, list[MarkerView]] = defaultdict(list)
    for picture in pictures:
        for marker in picture.markers:
            views[marker.number].append(MarkerView(calibration.cameras[picture.camera], marker))
    return views


def _preferred(setup: Setup, views: Sequence[MarkerView]) -> tuple[Sequence[MarkerView], bool]:
    """Return the views that count, and whether they are from a hand: an eye at 20 cm sees more than one at 1 m."""
    close = [view for view in views if _rides(setup, view.marker.camera)]
    return (close, True) if close else (views, False)


def _seen(verdict: Verdict, plate: MarkerPlate, views: Sequence[MarkerView], calibration: Calibration) -> SeenPart:
    assert verdict.estimate is not None
    return SeenPart(
        pose=component_pose(planar(verdict.estimate.pose), plate),
        uncertainty=combined(verdict.estimate, calibration.accuracy),
        how=verdict.how,
        height=verdict.estimate.height,
        cameras=tuple(view.marker.camera for view in views),
    )


def component_pose(marker: Pose, plate: MarkerPlate) -> Pose:
    """Return where a component stands whose marker is at `marker`."""
    return marker.compose(Pose(plate.at[0], plate.at[1]).inverse())


def _place(view: MarkerView, size: float, height: float) -> tuple[float, float]:
    x, y = flat_start(view, size, height)[:2, 3]
    return round(float(x), 1), round(float(y), 1)


def _finding(name: str, number: int, views: Sequence[MarkerView], plate: MarkerPlate, verdict: Verdict) -> Finding:
    at = tuple(_place(view, plate.size, plate.at[2]) for view in views)
    text = f"{name}: its marker {number} {verdict.text}"
    assert verdict.kind is not None
    return Finding(kind=verdict.kind, text=text, component=name, marker=number, at=at[:1])


def _duplicate(
    setup: Setup, number: int, views: Sequence[MarkerView], parts: Mapping[int, tuple[str, MarkerPlate]]
) -> Finding:
    name, plate = parts.get(number, (None, MarkerPlate(at=(0.0, 0.0, _HEIGHT), size=_SIZE)))
    by_camera: dict[str, list[MarkerView]] = defaultdict(list)
    for view in views:
        by_camera[view.marker.camera].append(view)
    most = max(by_camera.values(), key=len)
    at = tuple(sorted(_place(view, plate.size, plate.at[2]) for view in most))
    places = " and ".join(f"({x:.0f}, {y:.0f})" for x, y in at)
    text = f"{f'{name}: its ' if name else ''}marker {number} is on the table {len(at)} times, at {places}"
    return Finding(kind="duplicate", text=text, component=name, marker=number, at=at)


def _strangers(
    setup: Setup, views: Mapping[int, Sequence[MarkerView]], known: Collection[int], calibration: Calibration
) -> dict[str, Stranger]:
    return {
        f"unknown/{number}": _measured(number, _preferred(setup, seen)[0], calibration)
        for number, seen in sorted(views.items())
        if number not in known
    }


def _measured(number: int, views: Sequence[MarkerView], calibration: Calibration) -> Stranger:
    """Return a marker of which neither size nor height are known; from one camera, or where two do not see the same
    thing, both are taken to be usual."""
    if len(views) > 1 and meet(views):
        size = edge(triangulated(views))
        estimate = from_rays(views, size)
        sigma = combined(estimate, calibration.accuracy)
        return Stranger(marker=number, pose=planar(estimate.pose), uncertainty=sigma, height=estimate.height, size=size)
    pose = flat_start(views[0], _SIZE, _HEIGHT)
    size = edge(plane_points(views[0], _HEIGHT))
    sigma = Uncertainty(position=_HEIGHT / 2, yaw=1.0)
    return Stranger(marker=number, pose=planar(pose), uncertainty=sigma, height=_HEIGHT, size=size)


def _stranger(stranger: Stranger) -> Finding:
    at = (round(stranger.pose.x, 1), round(stranger.pose.y, 1))
    text = f"marker {stranger.marker} at ({at[0]:.0f}, {at[1]:.0f}) is not in the inventory"
    return Finding(kind="unknown", text=text, marker=stranger.marker, at=(at,))


def _half_seen(
    setup: Setup,
    pictures: Sequence[Markers],
    calibration: Calibration,
    components: Mapping[str, SeenPart],
    strangers: Mapping[str, Stranger],
) -> list[Finding]:
    """Return what looks like a marker on a part and can't be read, where no camera reads one."""
    places = [*(seen.pose for seen in components.values()), *(stranger.pose for stranger in strangers.values())]
    known = [(place.x, place.y) for place in places]
    known += [(datum.x, datum.y) for datum in setup.lab.datums.values()]
    found: list[Finding] = []
    for picture in pictures:
        for fragment in picture.fragments:
            view = MarkerView(calibration.cameras[picture.camera], read_marker(-1, fragment.corners, picture.camera))
            size = edge(plane_points(view, _HEIGHT))
            at = _place(view, _SIZE, _HEIGHT)
            if not 0.6 < size / _SIZE < 1.6 or any(_close(at, place) for place in known):
                continue
            known.append(at)
            text = (
                f"something at ({at[0]:.0f}, {at[1]:.0f}) looks like a marker and can't be read by `{picture.camera}`"
            )
            found.append(Finding(kind="half-seen", text=text, at=(at,)))
    return found


def _close(a: tuple[float, float], b: tuple[float, float]) -> bool:
    return abs(a[0] - b[0]) < _NEAR and abs(a[1] - b[1]) < _NEAR


def _hidden(
    parts: Mapping[int, tuple[str, MarkerPlate]], views: Collection[int], held: Collection[str]
) -> list[Finding]:
    return [
        Finding(kind="hidden", text=f"{name}: no camera sees its marker {number}", component=name, marker=number)
        for number, (name, _) in sorted(parts.items())
        if number not in views and name not in held
    ]


def _drift(
    setup: Setup, pictures: Sequence[Markers], calibration: Calibration
) -> tuple[tuple[CameraMoved, ...], tuple[str, ...], list[Finding]]:
    drift, checked, findings = [], [], []
    for picture in pictures:
        if _rides(setup, picture.camera):
            continue
        moved, loose = check(setup, picture, calibration.cameras[picture.camera], calibration.accuracy)
        drift += [moved] if moved else []
        findings += loose
        if not moved and not any(f.kind == "datums" for f in loose):
            checked.append(picture.camera)
    return tuple(drift), tuple(checked), findings
