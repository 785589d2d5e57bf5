"""Runs get SIGUSR1, SIGTERM or SIGINT at random instants of every phase, alone and under mpirun; and studies whose
phases take seconds, such as a row of a gigabyte, thousands of impacts or a map of hundreds of numbers. What is
expected: the run ends within 5 s, with 75 after SIGUSR1 (0 if it was at its end) and the code of the signal after the
others; resumed, the result is equal in every data set to the undisturbed one."""

import signal
import time

from campaign import Trial
from phases import PHASES, TARGETS, Subject, chance_of, finished_tasks, is_locked, kinds_of, study_of
from program import DONE, STOPPED, names, study, sweep, wait_until, write

SIGNALS = (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT)
MOST_SECONDS = 5


def expect_code(ended, number, ranks):
    if number == signal.SIGUSR1:
        assert ended.code in (STOPPED, DONE), ended
        if ended.code == STOPPED:
            ended.expect_line("", "stopped by", "--resume")
    elif ended.code != DONE:
        assert ended.code != STOPPED and (ranks or ended.code == -number), ended


def end_soon(run, number, ranks):
    """The run's end after a signal, and the seconds to it."""
    begin = time.monotonic()
    ended = run()
    seconds = time.monotonic() - begin
    expect_code(ended, number, ranks)
    assert seconds <= MOST_SECONDS, f"{seconds:.1f} s: {ended}"
    return ended, seconds


def signal_runs(subject, target, phase, number):
    def trial(ricochet, folder):
        at, ranks = TARGETS[target]
        chance = chance_of(f"{subject.name} {target} {phase} {number}")
        write(folder, "s.yaml", subject.text)
        run, there = subject.reach(ricochet, folder, ranks, phase, chance)
        if number == signal.SIGUSR1:
            run.wait_for_handlers(number)
        met = run.phase()
        at(run, number)
        ended, seconds = end_soon(lambda: run.end(60), number, ranks)
        wait_until(lambda: not is_locked(folder), "the end of the ranks", 30)
        if number == signal.SIGUSR1 and ended.code == STOPPED:
            assert "s.h5.tmp" not in names(folder), names(folder)
        finished = finished_tasks(folder)
        subject.expect_resumed(ricochet, folder, chance.choice((0, 1, 2, 3)), finished)
        return f"{'in ' + met if there else 'ended'}: code {ended.code} after {seconds:.2f} s; {len(finished)} resumed"

    return trial


# --- phases that take seconds ---


def large_map(size):
    rows = ", ".join("0.9" if i == j else "0.001" for i in range(size) for j in range(size))
    same = {name: f"[{', '.join([str(value)] * size)}]" for name, value in (("one", 1), ("three", 3), ("zero", 0))}
    return (
        f"kind: diagram\nmodel: {{type: grazing_map, L: [{rows}], eta: {same['one']}, xi: {same['one']}, "
        f"kappa: {same['three']}, d: 0.001}}\n"
        f"iterate: {{start: {same['zero']}, transient: 100000, keep: 10, lyapunov: true, exponents: 20}}\n"
    )


def many_hits(count):
    return ", ".join(str(i) for i in range(0, 3 * count, 3))


ROW = "kind: diagram\nmodel: {type: grazing_map, %s, d: 0.001}\niterate: {keep: 100000000, transient: 0, start: %s}\n"
LONG = {
    "a row of a gigabyte": ROW % ("lambda: 0.5, omega: 0.3", "[0, 0, 0]"),
    "a row of a map that diverges": ROW % ("L: [9], eta: [1], xi: [1], kappa: [3]", "1"),
    "samples of a gigabyte": "kind: trajectory\nmodel: {type: chain, particles: 3, gamma: 0.1}\nstart: {v: 2}\n"
                             "time: {duration: 1e6, samples: 20000000}\n",
    "a map of hundreds of numbers": large_map(300),
    "thousands of impacts": study(particles=7501, at_start=f"[{many_hits(2500)}]", orbit="states: false"),
    "singular points of many impacts": study(particles=2401, at_start=f"[{many_hits(800)}]",
                                             orbit="states: false, special_points: true", sweep=sweep(2, 0.01, 0.02)),
    "critical points of a chain": study(particles=200, at_start="[7]", sweep=sweep(2, 0.0, 0.18),
                                        orbit="states: false, stable: true, special_points: true"),
    "millions of particles": study(particles=4000001, at_start="[7]", orbit="states: false"),
    "a result of a gigabyte": study(particles=50000, at_start="[7]", sweep=sweep(600)),
}  # fmt: skip


def signal_long(name, text, number, instant):
    def trial(ricochet, folder):
        write(folder, "s.yaml", text)
        said = []
        for instants in (instant, 0.7 * instant):  # once more, with what the first has finished
            run = ricochet.start_run("s.yaml", "--resume", cwd=folder)
            time.sleep(instants)
            there = run.poll() is None
            run.send_signal(number)
            ended, seconds = end_soon(lambda run=run: ricochet.end(run, 120), number, 0)
            said.append(f"code {ended.code} after {seconds:.2f} s" if there else "ended")
        return ", ".join(said)

    return trial


def long_trials():
    for name, text in LONG.items():
        for instant in (1, 3, 6, 12, 24):
            for number in (signal.SIGUSR1, signal.SIGTERM):
                trial = signal_long(name, text, number, instant)
                yield Trial(f"{name}, {number.name} after {instant} s", trial, limit=200)


def trials(ricochet):
    subjects = [Subject(kind, study_of(ricochet, kind)) for kind in kinds_of(ricochet, ricochet.new_folder())]
    for subject in subjects:
        subject.prepare(ricochet)
    short = [
        Trial(f"{s.name} {phase} {target} {number.name}", signal_runs(s, target, phase, number), limit=180)
        for phase in PHASES
        for target in TARGETS
        for number in SIGNALS
        for s in subjects
    ]
    return [*long_trials(), *short]
