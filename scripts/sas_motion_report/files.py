# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Finding a tool and writing files that are never half written."""
import os
import shutil
import subprocess

from . import ReportError


def find_tool(name, option='--tool'):
    """Returns the path of a tool: beside the script, then in the catkin workspace, then on PATH; `option` is how the user may name it."""
    beside = os.path.dirname(os.path.dirname(os.path.realpath(__file__)))
    candidates = [os.path.join(beside, name)] + catkin_candidates(name)
    for path in candidates:
        if os.access(path, os.X_OK) and os.path.isfile(path):
            return path
    path = shutil.which(name)
    if path is None:
        raise ReportError(f'{name} is not found; build the package and source its setup.bash, or name the tool with {option}')
    return path


def catkin_candidates(name):
    """Returns where the catkin workspaces hold a tool of this package; empty without catkin."""
    try:
        from catkin.find_in_workspaces import find_in_workspaces
        found = find_in_workspaces(['libexec'], 'sas_motion', name)
        if found:
            return list(found)
    except (ImportError, OSError, ValueError, RuntimeError):
        pass
    return ask_catkin_find(name)


def ask_catkin_find(name):
    """Returns the lines of `catkin_find --libexec sas_motion NAME`; empty without it."""
    try:
        answer = subprocess.run(['catkin_find', '--libexec', 'sas_motion', name], check=False, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, universal_newlines=True, timeout=30)
    except (OSError, subprocess.TimeoutExpired):
        return []
    return answer.stdout.split('\n')[:-1]


def make_folder(folder):
    """Creates the folder for the results unless it is there."""
    try:
        os.makedirs(folder, exist_ok=True)
    except OSError as error:
        raise ReportError(f'the folder {folder} cannot be made ({error.strerror}); name another with -o') from None


def write_atomically(path, text):
    """Writes text under a temporary name, then renames it, so that `path` is whole or as it was."""
    temporary = f'{path}.{os.getpid()}.tmp'
    try:
        with open(temporary, 'w', encoding='utf-8') as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, path)
        sync_folder(os.path.dirname(os.path.abspath(path)))
    except OSError as error:
        raise ReportError(f'{path} cannot be written ({error.strerror}); free the disk or name another folder with -o') from None
    finally:
        if os.path.exists(temporary):
            os.remove(temporary)


def sync_folder(folder):
    """Makes a rename in this folder last through a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
