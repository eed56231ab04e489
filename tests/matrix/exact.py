# SPDX-License-Identifier: GPL-3.0-or-later
"""The exact motion of the two cars of a cell of a matrix, with an emergency brake in the own one: constant
jerk, then constant deceleration, from the instant at which the target becomes a threat by its TTC and by
the deceleration that avoiding it takes (src/control/lookout.h), to the first touch of the rectangles.
Written from the definitions, without a line of the program."""
import math

STEP_S = 1e-3
MEET_M = 300.0  # along both lines


class Line:
    """A polyline; places along it."""

    def __init__(self, points):
        self.points, self.at = points, [0.0]
        for (x, y), (u, v) in zip(points, points[1:]):
            self.at.append(self.at[-1] + math.hypot(u - x, v - y))

    def place(self, way):
        k = 0
        while k + 2 < len(self.points) and self.at[k + 1] < way:
            k += 1
        share = (way - self.at[k]) / (self.at[k + 1] - self.at[k])
        (x, y), (u, v) = self.points[k], self.points[k + 1]
        return x + share * (u - x), y + share * (v - y), math.atan2(v - y, u - x)


def straight(x, y, heading):
    c, s = math.cos(heading), math.sin(heading)
    return Line([(x - MEET_M * c, y - MEET_M * s), (x + MEET_M * c, y + MEET_M * s)])


def left_turn(radius, meet_y, steps=360):
    """So that the front has come meet_y to the left, at x = 0, after MEET_M."""
    meet = math.acos(1.0 - meet_y / radius)
    begin = -radius * math.sin(meet)
    arc = [(begin + radius * math.sin(a), radius * (1.0 - math.cos(a)))
           for a in (0.5 * math.pi * k / steps for k in range(steps + 1))]
    points = [(begin - MEET_M + radius * meet, 0.0), *arc, (arc[-1][0], arc[-1][1] + MEET_M)]
    return Line(points)


class Body:
    """A car whose front and rear bumper's middles are on its line."""

    def __init__(self, line, length, width):
        self.line, self.length, self.width = line, length, width

    def at(self, way):
        x, y, tangent = self.line.place(way)
        u, v, _ = self.line.place(way - self.length)
        heading = math.atan2(y - v, x - u)
        return x, y, heading, tangent

    def corners(self, way):
        x, y, heading, _ = self.at(way)
        c, s, half = math.cos(heading), math.sin(heading), 0.5 * self.width
        return [(x + a * c - b * s, y + a * s + b * c)
                for a, b in ((0, half), (0, -half), (-self.length, -half), (-self.length, half))]


def touch(one, other):
    for shape in (one, other):
        for (x, y), (u, v) in zip(shape, shape[1:] + shape[:1]):
            nx, ny = v - y, x - u
            a = [nx * p + ny * q for p, q in one]
            b = [nx * p + ny * q for p, q in other]
            if max(a) < min(b) or max(b) < min(a):
                return False
    return True


def may_touch(own, target, own_way, target_way):
    (x, y, *_), (u, v, *_) = own.at(own_way), target.at(target_way)
    return math.hypot(x - u, y - v) < own.length + target.length + own.width + target.width


def first_touch(own, own_way, target, target_way, until_s):
    """Time of the first touch, or None; ways are functions of time."""
    time_s = 0.0
    while time_s < until_s:
        if not may_touch(own, target, own_way(time_s), target_way(time_s)):
            time_s += 0.01
        elif touch(own.corners(own_way(time_s)), target.corners(target_way(time_s))):
            return time_s
        else:
            time_s += STEP_S
    return None


def sees(own, own_way, target, target_way, sensor):
    """Whether the middle, a corner or the middle of a side is in the sector."""
    x, y, heading, _ = own.at(own_way)
    corners = target.corners(target_way)
    for i in range(3):
        for k in range(3):
            a, b = i / 2, k / 2
            px = sum(w * p[0] for w, p in zip(((1 - a) * (1 - b), (1 - a) * b, a * b, a * (1 - b)), corners))
            py = sum(w * p[1] for w, p in zip(((1 - a) * (1 - b), (1 - a) * b, a * b, a * (1 - b)), corners))
            bearing = math.atan2(py - y, px - x) - heading
            bearing = abs(math.atan2(math.sin(bearing), math.cos(bearing)))
            if math.hypot(px - x, py - y) <= sensor["range"] and bearing <= 0.5 * sensor["view"]:
                return True
    return False


class Brake:
    def __init__(self, start_s, jerk, deceleration):
        self.start_s, self.jerk, self.hold = start_s, jerk, deceleration

    def loss(self, time_s):
        after, rise = max(0.0, time_s - self.start_s), self.hold / self.jerk
        return 0.5 * self.jerk * after * after if after < rise else self.hold * (after - 0.5 * rise)

    def lost_way(self, time_s):
        after, rise = max(0.0, time_s - self.start_s), self.hold / self.jerk
        rising, held = min(after, rise), max(0.0, after - rise)
        return self.jerk * rising ** 3 / 6 + 0.5 * self.jerk * rise * rise * held + 0.5 * self.hold * held * held


def cell(encounter, p, length, width, lead_s):
    """Own body, target body, their ways and speeds over time."""
    own_v, target_v = p["own_km_h"] / 3.6, p["target_km_h"] / 3.6
    side, hit = p["offset_1"] * width, p["impact_1"] * length
    own_line, own_start = straight(0, 0, 0), MEET_M - own_v * lead_s
    target_start, until = MEET_M - target_v * lead_s, math.inf
    stop = None
    if encounter == "rear_end":
        line, target_start = straight(0, side, 0), target_start + length
    elif encounter == "braking":
        line, target_v = straight(0, side, 0), own_v
        target_start, stop = own_start + p["headway_m"] + length, p["target_deceleration_m_s2"]
    elif encounter == "head_on":
        line = straight(0, side, math.pi)
    elif encounter == "crossing":
        line = straight(0.5 * width, 0, (-0.5 if p["from_left_1"] else 0.5) * math.pi)
        target_start += hit
    else:
        own_line = left_turn(p["radius_m"], p["lane_m"] - 0.5 * width)
        line, target_start = straight(0, p["lane_m"], math.pi), target_start + hit

    def target_way(time_s):
        braking = max(0.0, time_s - 2.0) if stop else 0.0
        braking = min(braking, target_v / stop) if stop else 0.0
        driven = min(time_s, 2.0) if stop else time_s
        return target_start + target_v * (driven + braking) - (0.5 * stop * braking ** 2 if stop else 0.0)

    def target_speed(time_s):
        return max(0.0, target_v - stop * max(0.0, time_s - 2.0)) if stop else target_v

    return (Body(own_line, length, width), Body(line, length, width), own_start, own_v, target_way,
            target_speed)


def request_s(encounter, own, target, own_start, own_v, target_way, target_speed, aeb):
    """When the target becomes a threat that is known; None: never."""
    def unbraked(time_s):
        return own_start + own_v * time_s
    seen_s = time_s = 0.0
    while time_s < 8.0 and not sees(own, unbraked(time_s), target, target_way(time_s), aeb):
        time_s += 0.01
        seen_s = time_s
    known_s = seen_s + aeb["confirmation"]
    if encounter == "braking":
        time_s = known_s
        while time_s < 12.0:
            gap = target_way(time_s) - own.length - unbraked(time_s)
            closing = own_v - target_speed(time_s)
            if closing > 0 and gap / closing < aeb["ttc"] and closing * closing >= 2 * gap * aeb["required"]:
                return time_s
            time_s += STEP_S
        return None
    meet_s = first_touch(own, unbraked, target, target_way, 12.0)
    if meet_s is None:
        return None
    speed = own_v - (target_speed(0) if encounter == "rear_end" else 0.0)
    limit_s = aeb["ttc"] if aeb["required"] <= 0 else min(aeb["ttc"], speed / (2 * aeb["required"]))
    asked_s = max(known_s, meet_s - limit_s)
    return asked_s if asked_s < meet_s else None


def impact_m_s(encounter, p, aeb, length=4.5, width=1.8, lead_s=6.0):
    """Own forward speed at the first touch; None: there is none."""
    own, target, own_start, own_v, target_way, target_speed = cell(encounter, p, length, width, lead_s)
    asked_s = request_s(encounter, own, target, own_start, own_v, target_way, target_speed, aeb)
    brake = Brake(math.inf if asked_s is None else asked_s + aeb["delay"], aeb["jerk"], aeb["deceleration"])
    stands_s = math.inf if asked_s is None else \
        brake.start_s + own_v / brake.hold + 0.5 * brake.hold / brake.jerk

    def way(time_s):
        time_s = min(time_s, stands_s)
        return own_start + own_v * time_s - brake.lost_way(time_s)
    touch_s = first_touch(own, way, target, target_way, 14.0)
    if touch_s is None:
        return None
    _, _, heading, tangent = own.at(way(touch_s))
    return max(0.0, own_v - brake.loss(touch_s)) * math.cos(tangent - heading)
