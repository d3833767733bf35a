# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""Runs tasks on a Dask cluster: one of this machine, or one that an address names.

A task of Dask is subprocess.run of a run_campaign command line, so a worker needs nothing of ours but that program and the suite,
under the same paths as here. Dask runs the chunks of a lost worker again; since a run depends on its seed alone, that changes nothing.
"""
import contextlib
import logging
import signal
import subprocess
import tempfile

from sas_motion_report import ReportError

from .plan import contiguous_chunks
from .worker import cannot_run, failure, read_record

LOCAL = 'local'
CHUNKS_A_THREAD = 8  # so that the last ones end together
LARGEST_CHUNK = 64  # tasks, what a lost worker costs
TRIES = 3  # of a process that a signal ends
PATIENCE = 5  # [s] to reach the scheduler


def run_on_dask(worker, plan, missing, jobs, address, save):
    """Computes the missing tasks; calls save(first, records) as chunks come."""
    try:
        import distributed
    except ImportError:
        raise ReportError('dask.distributed is not installed; install python3-distributed, or leave out --scheduler') from None
    with contextlib.ExitStack() as stack:
        client = connect(distributed, stack, jobs, address)
        threads = max(1, sum(client.nthreads().values()))
        size = min(LARGEST_CHUNK, max(1, len(missing) // (CHUNKS_A_THREAD * threads)))
        chunks = {submit(client, worker, chunk): (chunk, 1) for chunk in contiguous_chunks(missing, size)}
        answers = distributed.as_completed(list(chunks))
        for future in answers:
            chunk, tries = chunks.pop(future)
            done = result(future, worker)
            if done.returncode < 0 and tries < TRIES:
                again = submit(client, worker, chunk)
                chunks[again] = (chunk, tries + 1)
                answers.add(again)
                continue
            save(chunk[0], read_chunk(plan, chunk, done))


def connect(distributed, stack, jobs, address):
    """Returns the client of the cluster; a local one lives as long as the stack."""
    if address == LOCAL:
        folder = stack.enter_context(tempfile.TemporaryDirectory(prefix='benchmark-dask-'))
        with deaf_to_interrupts():
            cluster = stack.enter_context(distributed.LocalCluster(n_workers=jobs, threads_per_worker=1, processes=True, dashboard_address=None,
                                                                   local_directory=folder, silence_logs=logging.CRITICAL))
        return stack.enter_context(distributed.Client(cluster))
    logging.getLogger('distributed').setLevel(logging.CRITICAL)
    try:
        return stack.enter_context(distributed.Client(address, timeout=PATIENCE))
    except (OSError, ValueError) as error:
        raise ReportError(f'no Dask scheduler answers at {address} ({type(error).__name__}); start one with dask-scheduler, '
                          'give its address, or use --scheduler local') from None


@contextlib.contextmanager
def deaf_to_interrupts():
    """Lets the processes that start meanwhile pass over Ctrl-C: we end them, and a traceback of each would hide what we say."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


def submit(client, worker, chunk):
    """Returns the future of a chunk's process."""
    return client.submit(subprocess.run, worker.command(chunk, 1), pure=False, stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True)


def result(future, worker):
    """Returns the finished process of a future."""
    from distributed import CancelledError, KilledWorker
    try:
        return future.result()
    except KilledWorker:
        raise ReportError('several Dask workers died on the same chunk; look at their logs (memory?), then start again to go on') from None
    except CancelledError:
        raise ReportError('the Dask scheduler went away; what is done is kept, so start it again and this command to go on') from None
    except OSError as error:
        raise ReportError(f'on a Dask worker, {cannot_run(worker.program, error)}; it must be there under the same path') from None


def read_chunk(plan, chunk, done):
    """Returns the checked records of a chunk's process."""
    arguments = f'--tasks {chunk[0]}:{chunk[1]}'
    if done.returncode != 0:
        raise ReportError(failure(done.returncode, done.stderr, arguments))
    lines = done.stdout.splitlines()
    if len(lines) != chunk[1] - chunk[0]:
        raise ReportError(f'run_campaign {arguments} printed {len(lines)} lines; build run_campaign and benchmark from the same source')
    return [read_record(plan, line, task) for task, line in enumerate(lines, chunk[0])]
