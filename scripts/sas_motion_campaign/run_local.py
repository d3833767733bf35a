# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs tasks on this machine: one run_campaign at a time, its threads being the jobs."""
import subprocess
import threading
import time

from sas_motion_report import ReportError

from .plan import contiguous_chunks
from .worker import cannot_run, failure, read_record

CHUNK = 1000  # tasks a process: its last tasks leave cores idle, so few processes are better
SAVE_INTERVAL = 1.0  # [s] between writes, so that a crash costs little
TRIES = 3  # of a process that a signal ends


def run_locally(worker, plan, missing, jobs, save):
    """Computes the missing tasks; calls save(first, records) as they come."""
    for first, last in contiguous_chunks(missing, CHUNK):
        tries = 0
        while first < last:
            done, status, complaint = run_chunk(worker, plan, (first, last), jobs, save)
            # what a killed process had printed counts, so only the rest runs again
            tries = 1 if done else tries + 1
            first += done
            if status > 0 or (status < 0 and tries >= TRIES):
                raise ReportError(failure(status, complaint, f'--tasks {first}:{last}'))
            if status == 0 and first < last:
                raise ReportError(f'run_campaign ended before task {first} of {last}; build run_campaign and benchmark from the same source')


def run_chunk(worker, plan, chunk, jobs, save):
    """Runs one process; returns how many tasks it answered, its status and what it complained of."""
    try:
        process = subprocess.Popen(worker.command(chunk, jobs), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)
    except OSError as error:
        raise ReportError(cannot_run(worker.program, error)) from None
    complaints = []
    listener = threading.Thread(target=lambda: complaints.append(process.stderr.read()), daemon=True)  # a full pipe would stop the process
    listener.start()
    try:
        done = collect(process.stdout, plan, chunk, save)
        status = process.wait()
        listener.join()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()
    return done, status, ''.join(complaints)


def collect(lines, plan, chunk, save):
    """Saves records as they are printed, about once a second; returns how many there were."""
    waiting, saved, due = [], chunk[0], time.monotonic() + SAVE_INTERVAL
    for line in lines:
        if not line.endswith('\n'):
            break  # torn by the end of the process
        waiting.append(read_record(plan, line, saved + len(waiting)))
        if time.monotonic() >= due:
            save(saved, waiting)
            saved, waiting, due = saved + len(waiting), [], time.monotonic() + SAVE_INTERVAL
    if waiting:
        save(saved, waiting)
    return saved + len(waiting) - chunk[0]
