# SPDX-FileCopyrightText: 2026 The sas_motion authors
# SPDX-License-Identifier: BSD-3-Clause
"""How the front `benchmark` schedules, resumes and gives up: the same bytes however the runs came about."""
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time

import campaign_front as front
import pytest
import toolbox

sys.path.insert(0, str(front.ROOT / 'scripts'))

from sas_motion_campaign.run_dask import read_chunk  # noqa: E402
from sas_motion_report import ReportError  # noqa: E402


@pytest.fixture(scope='module')
def reference(tmp_path_factory):
    """The folder of a campaign that ran undisturbed."""
    folder = tmp_path_factory.mktemp('reference')
    front.succeed(folder, 'out', '--jobs', 1)
    return folder


def partial(folder):
    """The runs that are saved so far."""
    path = folder / 'out' / 'results.partial.jsonl'
    return path.read_text().splitlines() if path.exists() else []


def wait_for(condition, seconds=40):
    """Waits until the condition holds."""
    limit = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < limit, 'waited in vain'
        time.sleep(0.02)


def start(folder, *arguments, **extra):
    """A front that runs beside the test."""
    return subprocess.Popen(front.command(folder, '-o', folder / 'out', '--no-report', *arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            universal_newlines=True, env=front.environment(**extra),
                            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))  # which a shell's background jobs ignore


def interrupted(folder):
    """Runs the front until something is saved, then kills it without warning."""
    process = start(folder, STUB_DELAY=0.03)
    wait_for(lambda: len(partial(folder)) > 5)
    process.kill()
    process.communicate()


def test_a_line_a_run_in_task_order(reference):
    lines = [json.loads(line) for line in (reference / 'out' / 'results.jsonl').read_text().splitlines()]
    assert [(line['campaign'], line['law'], line['seed']) for line in lines] == [
        (c['name'], law['name'], seed) for c in front.SUITE['campaigns'] for law in c['laws'] for seed in range(5, 17)]
    assert all(set(line) == {'suite', 'campaign', 'law', 'seed', 'config_hash', 'version', 'results'} for line in lines)
    assert sorted(os.listdir(reference / 'out')) == ['costs.json', 'results.jsonl', 'summary.json']


def test_jobs_change_no_byte(reference, tmp_path):
    front.succeed(tmp_path, 'out', '--jobs', 2)
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')


def test_a_second_start_computes_nothing(reference, tmp_path):
    front.succeed(tmp_path, 'out')
    costs = (tmp_path / 'out' / 'costs.json').read_bytes()
    front.succeed(tmp_path, 'out', STUB_FAIL=0)  # a task would fail, were one run
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')
    assert (tmp_path / 'out' / 'costs.json').read_bytes() == costs


def test_resume_after_a_kill(reference, tmp_path):
    # GIVEN a front that was killed, and a last line that it did not finish
    interrupted(tmp_path)
    saved = len(partial(tmp_path))
    with open(tmp_path / 'out' / 'results.partial.jsonl', 'a', encoding='utf-8') as file:
        file.write('{"suite": "sample", "camp')
    # WHEN it starts again, and finished tasks would fail
    front.succeed(tmp_path, 'out', STUB_FAIL=saved - 1)
    # THEN the results are those of an undisturbed campaign
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')
    assert not (tmp_path / 'out' / 'results.partial.jsonl').exists()


def test_more_runs_reuse_what_is_there(reference, tmp_path):
    front.succeed(tmp_path, 'out', '--runs', 5)
    costs = json.loads((tmp_path / 'out' / 'costs.json').read_text())['campaigns']['towfish']['bursts']['kf']['runs']
    front.succeed(tmp_path, 'out', STUB_FAIL=4)  # task 4 is seed 9 of the first law in both
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')
    assert json.loads((tmp_path / 'out' / 'costs.json').read_text())['campaigns']['towfish']['bursts']['kf']['runs'][:5] == costs


def test_another_campaign_in_the_folder_is_refused(tmp_path):
    front.succeed(tmp_path, 'out')
    before = front.outputs(tmp_path, 'out')
    front.refused(front.benchmark(tmp_path, 'out', '--runs', 3), 'out holds', '--fresh')
    front.write_suite(tmp_path, first_seed=7)
    front.refused(front.benchmark(tmp_path, 'out'), 'results.jsonl line 1', 'config_hash', '--fresh')
    assert front.outputs(tmp_path, 'out') == before
    front.succeed(tmp_path, 'out', '--fresh')
    assert front.outputs(tmp_path, 'out') != before


def test_a_foreign_file_is_not_overwritten(tmp_path):
    (tmp_path / 'out').mkdir()
    (tmp_path / 'out' / 'results.jsonl').write_text('older\n')
    front.refused(front.benchmark(tmp_path, 'out'), 'results.jsonl line 1', '--fresh')
    assert (tmp_path / 'out' / 'results.jsonl').read_text() == 'older\n'


def test_two_fronts_do_not_share_a_folder(tmp_path):
    first = start(tmp_path, STUB_DELAY=0.05)
    try:
        wait_for(lambda: partial(tmp_path))
        front.refused(front.benchmark(tmp_path, 'out'), 'another benchmark', '-o')
    finally:
        first.kill()
        first.communicate()


def test_ctrl_c_keeps_what_is_done(tmp_path):
    process = start(tmp_path, STUB_DELAY=0.03)
    wait_for(lambda: partial(tmp_path))
    process.send_signal(signal.SIGINT)
    _, stderr = process.communicate(timeout=60)
    assert process.returncode == 130 and 'start again' in stderr and 'Traceback' not in stderr
    assert partial(tmp_path)


@pytest.mark.parametrize('scheduler', [[], ['--scheduler', 'local']], ids=['local', 'dask'])
def test_a_killed_run_campaign_runs_again(scheduler, reference, tmp_path):
    front.succeed(tmp_path, 'out', *scheduler, STUB_DIE=tmp_path / 'died')
    assert (tmp_path / 'died').exists()
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')


def lose_a_worker(folder, *arguments):
    """Runs the front on a cluster of two workers, of which one is killed in the middle; returns how many runs were saved then."""
    distributed = pytest.importorskip('distributed')
    cluster = distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, local_directory=str(folder / 'dask'),
                                       silence_logs=50)
    with cluster, distributed.Client(cluster) as client:
        process = start(folder, '--scheduler', cluster.scheduler_address, *arguments)
        wait_for(lambda: len(partial(folder)) > 5)
        pids = client.run(os.getpid)
        os.kill(sorted(pids.values())[0], signal.SIGKILL)
        before = len(partial(folder))
        _, stderr = process.communicate(timeout=90)
        assert process.returncode == 0, stderr
    return before


def test_a_killed_dask_worker_changes_nothing(reference, tmp_path, monkeypatch):
    monkeypatch.setenv('STUB_DELAY', '0.03')
    assert lose_a_worker(tmp_path) < 60
    assert front.outputs(tmp_path, 'out') == front.outputs(reference, 'out')


def test_a_killed_dask_worker_changes_nothing_of_a_real_campaign(tmp_path):
    # GIVEN a small campaign of the towfish, run undisturbed
    runs, worker = 40, ('--worker', toolbox.TOOLS / 'run_campaign')
    front.write_suite(tmp_path, runs=runs, campaigns=[{'name': 'towfish', 'scenario': str(toolbox.SCENARIOS / 'random_walk_asynchronous.yaml'),
                                                       'estimators': ['kf', 'bank_kf'], 'laws': front.LAWS[:1]}])
    front.succeed(tmp_path, 'reference', *worker)
    # WHEN a Dask worker is killed while it runs again
    assert lose_a_worker(tmp_path, *worker) < runs
    # THEN the bytes are the same
    assert front.outputs(tmp_path, 'out') == front.outputs(tmp_path, 'reference')


def test_a_failing_task_is_told_in_its_own_words(tmp_path):
    front.refused(front.benchmark(tmp_path, 'out', STUB_FAIL=40), 'benchmark: task 40', 'positive definite')
    front.succeed(tmp_path, 'out', STUB_FAIL=0)  # what was done is kept


def test_a_failing_chunk_on_dask_is_told_in_its_own_words():
    done = subprocess.CompletedProcess([], 1, '', 'run_campaign: task 40: the covariance is not positive definite\n')
    with pytest.raises(ReportError, match='task 40: the covariance'):
        read_chunk(None, (32, 48), done)


@pytest.mark.parametrize('size', [0, 4096])
def test_a_full_disk(size, reference, tmp_path):
    # GIVEN a folder with a good output, and a disk with room for almost nothing
    shutil.copytree(reference / 'out', tmp_path / 'out')
    before = front.outputs(tmp_path, 'out')

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
    # WHEN the front writes there, and into an empty folder
    for out in ('out', 'empty'):
        arguments = front.command(tmp_path, '-o', tmp_path / out, '--no-report')
        done = subprocess.run(arguments, stderr=subprocess.PIPE, stdout=subprocess.PIPE, universal_newlines=True, check=False, preexec_fn=limit, env=front.environment())
        # THEN it says so and the good output stands
        front.refused(done, str(tmp_path / out))
    assert front.outputs(tmp_path, 'out') == before
    assert sorted(os.listdir(tmp_path / 'out')) == ['costs.json', 'results.jsonl', 'summary.json']


def test_what_cannot_work_is_said(tmp_path):
    front.refused(front.benchmark(tmp_path, 'out', '--worker', tmp_path / 'absent'), 'absent', '--worker')
    front.refused(front.benchmark(tmp_path, 'out', '--scheduler', 'tcp://127.0.0.1:9'), 'tcp://127.0.0.1:9', 'scheduler')
    (tmp_path / 'file').write_text('')
    front.refused(front.benchmark(tmp_path, 'file/out'), 'file/out', '-o')
    (tmp_path / 'suite.yaml').rename(tmp_path / 'other.yaml')
    front.write_suite(tmp_path, campaigns=[front.SUITE['campaigns'][0]] * 2)
    front.refused(front.benchmark(tmp_path, 'out'), 'name of its own')
    for arguments in (['--runs', '0'], ['--jobs', 'x']):
        done = front.benchmark(tmp_path, 'out', *arguments)
        assert done.returncode == 2 and done.stderr.count('\n') == 1
