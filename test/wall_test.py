#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""The walls and floors of the source tree.

usage: wall_test.py SOURCE_DIR    exit status 1 where an include crosses a wall or leads up

Floors: a room includes only rooms below it, so that there are no circles. A room outside systems/ and tools/ knows no system,
and a system no other one, but for SYSTEM_USES.
Walls: ROS is used only by ROS_ROOMS, GTSAM only by the rooms named graph.
Public headers include no private ones, and there are fewer than PUBLIC_HEADERS.
The check first tries itself on a small tree with known violations.
"""
import pathlib
import re
import sys
import tempfile

# From the bottom. A room may include every room of the floors below it, and those to its left on its own floor.
FLOORS = [
    ['math', 'parallel', 'io'],
    ['robust', 'navigation'],
    ['config'],
    ['filters', 'noise'],
    ['estimate'],
    ['session', 'imaging'],
    ['evaluation'],
    ['campaign'],
    ['graph'],
    ['systems/*'],
    ['systems/*/graph'],
    ['ros'],
    ['bag'],
    ['systems/*/ros'],
    ['systems'],  # the files directly in it: the registry
    ['tools'],
]
SYSTEM_USES = {('sins_dvl', 'ins_gps_dvl')}  # SINS and DVL takes its mechanisation and graph from the system of the INS
ROS_ROOMS = {'ros', 'bag', 'systems/*/ros', 'systems', 'tools'}
GRAPH_ROOMS = {'graph', 'systems/*/graph'}
PUBLIC_HEADERS = 150
ORDER = [kind for floor in FLOORS for kind in floor]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
ROS = re.compile(r'^(ros|rosbag|rosconsole|roscpp|rosgraph_msgs|tf|tf2|tf2_ros|tf2_\w+|nodelet|pluginlib|class_loader|topic_tools|'
                 r'message_filters|diagnostic_updater|dynamic_reconfigure|\w+_msgs|std_srvs|sas_motion_msgs)/'
                 r'|^sas_motion/[A-Z]\w*\.h$')  # generated messages and services
GTSAM = re.compile(r'^gtsam(_unstable)?/')


def room_of(parts):
    """The room of a file, by its path below src or include/sas_motion: 'filters', 'systems', 'systems/usbl', 'systems/usbl/ros'."""
    if parts[0] != 'systems' or len(parts) == 2:
        return parts[0]
    return '/'.join(parts[:3] if parts[2] in ('graph', 'ros') and len(parts) > 3 else parts[:2])


def kind_of(room):
    """The room as the floors name it: a system's own name is a star there."""
    parts = room.split('/')
    return '/'.join([parts[0], '*', *parts[2:]]) if len(parts) > 1 else room


def system_of(room):
    parts = room.split('/')
    return parts[1] if len(parts) > 1 else None


def included_file(path, bracket, name):
    """An included file's path below src or include/sas_motion, as parts; nothing where it is not ours. And whether it is included as a public one."""
    if name.startswith('sas_motion/'):
        parts = pathlib.PurePosixPath(name).parts[1:]
        return (parts if len(parts) > 1 and parts[0] in ORDER else None), True
    parts = pathlib.PurePosixPath(name).parts
    if bracket == '"' and name.endswith('.hpp'):  # ROS, too, has a folder ros, of .h files
        if (path.parent / name).is_file():
            return None, False
        if parts[0] in ORDER and len(parts) > 1:
            return parts, False
    return None, False


def files(root):
    """(path, its room, whether it is public) of every source file."""
    for top, public in ((root / 'include' / 'sas_motion', True), (root / 'src', False)):
        for path in sorted(top.rglob('*')):
            if path.suffix in {'.hpp', '.h', '.cpp'}:
                yield path, room_of(path.relative_to(top).parts), public


def includes(path):
    """(line number, bracket, name) of every include of a file."""
    for number, line in enumerate(path.read_text(encoding='utf-8').splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1], match[2]


def room_includes(root):
    """(path, line number, room, included room) of every include of another room."""
    for path, room, _ in files(root):
        for number, bracket, name in includes(path):
            parts, _ = included_file(path, bracket, name)
            if parts and room_of(parts) != room:
                yield path, number, room, room_of(parts)


def wrong_room(room, included):
    """Why a room may not include another, if so."""
    system, other = system_of(room), system_of(included)
    kind = kind_of(room)
    generic = kind != 'tools' and kind.split('/')[0] != 'systems'
    if generic and (other or included == 'systems'):
        return 'which is of a system, in a room that knows none'
    if kind in ORDER and kind_of(included) in ORDER:
        if kind != kind_of(included) and ORDER.index(kind) < ORDER.index(kind_of(included)):
            return f'which leads up: {room} lies below {included}'
    if system and other and system != other and (system, other) not in SYSTEM_USES:
        return 'which is of another system'
    if kind_of(included) in GRAPH_ROOMS and kind not in GRAPH_ROOMS | ROS_ROOMS:
        return 'which lies behind the wall of GTSAM'
    return None


def wrong_include(path, room, public, bracket, name):
    """Why a file may not include another, if so."""
    parts, as_public = included_file(path, bracket, name)
    if parts:
        if public and not as_public:
            return 'a private header, in a public one'
        return wrong_room(room, room_of(parts))
    if ROS.match(name) and kind_of(room) not in ROS_ROOMS:
        return 'which lies behind the wall of ROS'
    if GTSAM.match(name) and kind_of(room) not in GRAPH_ROOMS:
        return 'which lies behind the wall of GTSAM'
    return None


def violations(root):
    """(file, line, what is wrong) of every file outside the floors and every include that is not allowed; the number of files; of public headers."""
    found, looked, headers = [], 0, 0
    for path, room, public in files(root):
        looked, headers = looked + 1, headers + public
        name = path.relative_to(root).as_posix()
        if kind_of(room) not in ORDER:
            found.append((name, 1, f'lies in {room}, which is on no floor'))
        for number, bracket, included in includes(path):
            wrong = wrong_include(path, room, public, bracket, included)
            if wrong:
                found.append((name, number, f'includes {included}, {wrong}'))
    return found, looked, headers


KNOWN = {  # a small tree, and how many violations each of its files has
    # the wall of ROS
    'include/sas_motion/filters/a.hpp': ('#include <ros/ros.h>\n', 1),
    'include/sas_motion/filters/b.hpp': ('#include <Eigen/Core>\n#include "sas_motion/math/types.hpp"\n', 0),
    'src/filters/c.cpp': ('#  include "sensor_msgs/NavSatFix.h"\n#include <tf2_ros/buffer.h>\n', 2),
    'src/session/d.cpp': ('#include <sas_motion/Audit.h>\n', 1),
    'src/math/e.cpp': ('// #include <ros/ros.h>\n', 0),
    'src/ros/f.cpp': ('#include <ros/ros.h>\n#include "ros/inbox.hpp"\n#include <sas_motion/EstimatorsConfig.h>\n', 0),
    'src/tools/g.cpp': ('#include <rosbag/bag.h>\n', 0),
    'src/systems/usbl/h.cpp': ('#include <rosbag/bag.h>\n', 1),
    'src/systems/usbl/ros/i.cpp': ('#include <ros/ros.h>\n#include "ros/inbox.hpp"\n#include "bag/bag_reader.hpp"\n', 0),
    'src/systems/registry.cpp': ('#include <ros/ros.h>\n#include "systems/usbl/ros/i.hpp"\n#include "systems/usbl/graph/batch.hpp"\n', 0),
    # the wall of GTSAM
    'src/filters/j.cpp': ('#include <gtsam/nonlinear/Values.h>\n', 1),
    'src/graph/k.cpp': ('#include <gtsam/nonlinear/Values.h>\n#include <nodelet/nodelet.h>\n', 1),
    'src/systems/usbl/l.cpp': ('#include "systems/usbl/graph/batch.hpp"\n#include "graph/levenberg_marquardt.hpp"\n', 2),
    'src/systems/usbl/graph/m.cpp': ('#include <gtsam_unstable/base/BTree.h>\n#include "graph/levenberg_marquardt.hpp"\n#include <ros/ros.h>\n', 1),
    'src/systems/usbl/ros/n.cpp': ('#include "systems/usbl/graph/batch.hpp"\n#include <gtsam/nonlinear/Values.h>\n', 1),
    # floors
    'src/math/o.cpp': ('#include "sas_motion/io/fingerprint.hpp"\n', 1),
    'src/io/p.cpp': ('#include "sas_motion/math/types.hpp"\n', 0),
    'include/sas_motion/estimate/q.hpp': ('#include "sas_motion/session/session.hpp"\n#include <sas_motion/filters/b.hpp>\n', 1),
    'src/filters/particles/r.cpp': ('#include "evaluation/scores.hpp"\n#include "filters/particles/r.hpp"\n', 1),
    'src/ros/s.cpp': ('#include "bag/bag_reader.hpp"\n#include "campaign/suite.hpp"\n', 1),
    'src/systems/usbl/t.cpp': ('#include "systems/usbl/ros/i.hpp"\n#include "campaign/system.hpp"\n', 1),
    'src/systems/usbl/graph/u.cpp': ('#include "systems/usbl/t.hpp"\n#include "systems/usbl/ros/i.hpp"\n', 1),
    'src/bag/v.cpp': ('#include "tools/progress.hpp"\n', 1),
    # systems
    'src/evaluation/w.cpp': ('#include "sas_motion/systems/usbl/model.hpp"\n', 1),
    'src/bag/x.cpp': ('#include "systems/registry.hpp"\n#include "systems/usbl/ros/i.hpp"\n', 2),
    'src/tools/y.cpp': ('#include "systems/registry.hpp"\n#include "systems/usbl/ros/i.hpp"\n', 0),
    'src/systems/towfish/z.cpp': ('#include "sas_motion/systems/usbl/model.hpp"\n', 1),
    'src/systems/towfish/ros/aa.cpp': ('#include "systems/usbl/ros/i.hpp"\n#include "sas_motion/systems/usbl/model.hpp"\n', 2),
    'src/systems/sins_dvl/ab.cpp': ('#include "sas_motion/systems/ins_gps_dvl/model.hpp"\n', 0),
    'src/systems/sins_dvl/graph/ac.cpp': ('#include "systems/ins_gps_dvl/graph/chain.hpp"\n', 0),
    'src/systems/sins_dvl/graph/ad.cpp': ('#include "systems/ins_gps_dvl/ros/ingest.hpp"\n', 1),
    'src/systems/ins_gps_dvl/ros/ae.cpp': ('#include "sas_motion/systems/sins_dvl/model.hpp"\n', 1),
    # public headers, and a room that no floor has
    'include/sas_motion/io/af.hpp': ('#include "io/private.hpp"\n', 1),
    'src/attic/ag.cpp': ('#include <vector>\n', 1),
}


def check_the_check():
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        for name, (text, _) in KNOWN.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(text, encoding='utf-8')
        found, looked, headers = violations(root)
    names = [name for name, _, _ in found]
    wrong = [name for name, (_, expected) in KNOWN.items() if names.count(name) != expected]
    if wrong or looked != len(KNOWN) or headers != sum(name.startswith('include') for name in KNOWN):
        sys.exit(f'wall_test: the check itself is wrong about {", ".join(wrong) or "the number of files"}')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    check_the_check()
    found, looked, headers = violations(pathlib.Path(sys.argv[1]))
    for name, number, wrong in found:
        print(f'{name}:{number}: {wrong}')
    if looked < 20:
        sys.exit(f'wall_test: only {looked} files found below {sys.argv[1]}; is this the source folder?')
    print(f'{looked} files, {headers} public headers, {len(found)} violations')
    if headers >= PUBLIC_HEADERS:
        sys.exit(f'wall_test: {PUBLIC_HEADERS} or more public headers; what only one .cpp needs belongs into src')
    sys.exit(1 if found else 0)


if __name__ == '__main__':
    main()
