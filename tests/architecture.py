"""The include lines keep to the arrows between the folders (docs/architecture.md)."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[1]

# room -> rooms that it may include from, beside itself; the longest matching path names the room
VIEWS = {"common/" + name for name in ("instruction_set.hpp", "lanes.hpp", "ordered_sum.hpp", "state.hpp",
                                       "vec.hpp")}
GEOMETRY = {"common/" + name for name in ("facet_contact.hpp", "facet_grid.hpp", "spatial_order.hpp", "surface.hpp",
                                         "surface_topology.hpp", "time_table.hpp")}
ALLOWED = {
    "common": set(),
    "dem_core": VIEWS | GEOMETRY,
    "fem_core": VIEWS | GEOMETRY,
    "dem_core/program": {"dem_core", "common", "coupler/participant", "coupler/channel", "coupler/protocol"},
    "fem_core/program": {"fem_core", "common", "coupler/participant", "coupler/channel", "coupler/protocol"},
    "coupler/protocol": set(),
    "coupler/channel": {"coupler/protocol"},
    "coupler/participant": {"coupler/channel", "coupler/protocol"},
    "coupler/methods": {"common"},
    "coupler/broker": {"coupler/methods", "coupler/participant", "coupler/channel", "coupler/protocol", "common"},
    "coupler/adapters": {"coupler/participant"},
    "coupler/commands": {"coupler/broker", "coupler/protocol", "common"},
}


def room_of(path):
    rooms = [room for room in ALLOWED if path == room or path.startswith(room + "/")]
    return max(rooms, key=len, default=None)


def violations(files):
    """(file, included path) of every include that no arrow allows. files: {path: text}"""
    found = []
    for path, text in files.items():
        room = room_of(path)
        for included in re.findall(r'^#include "([^"]+)"', text, re.M):
            target = room_of(included)
            allowed = {room} | ALLOWED[room]
            if not any(included == a or (target == a) for a in allowed):
                found.append((path, included))
    return found


class Architecture(unittest.TestCase):
    def test_no_file_includes_against_an_arrow(self):
        files = {str(p.relative_to(ROOT)): p.read_text()
                 for folder in ("common", "dem_core", "fem_core", "coupler")
                 for p in (ROOT / folder).rglob("*.?pp")}
        self.assertGreater(len(files), 100)
        self.assertEqual([p for p in files if room_of(p) is None], [])
        self.assertEqual(violations(files), [])

    def test_a_forbidden_include_is_seen(self):
        self.assertTrue(violations({"dem_core/engine.cpp": '#include "fem_core/mesh.hpp"\n'}))
        self.assertTrue(violations({"dem_core/engine.cpp": '#include "common/results.hpp"\n'}))
        self.assertTrue(violations({"coupler/adapters/echo/echo.cpp": '#include "coupler/broker/broker.hpp"\n'}))
        self.assertTrue(violations({"coupler/broker/broker.cpp": '#include "dem_core/engine.hpp"\n'}))
        self.assertFalse(violations({"dem_core/program/main.cpp": '#include "dem_core/engine.hpp"\n'}))


if __name__ == "__main__":
    unittest.main()
