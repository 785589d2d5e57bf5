"""Runs are killed (SIGKILL) at random instants of every phase: at the start, among the tasks, at the tables that follow
them, while the result is written, and at the end; alone, one rank, mpirun, all of them. Every third is killed once more
when it is resumed. What is expected: no finished task lost or computed again; resumed with another number of ranks, the
result equal in every data set to the undisturbed one; nothing left behind, nothing running."""

from campaign import Known, Trial
from phases import KILL, PHASES, TARGETS, Subject, chance_of, finished_tasks, kinds_of, study_of
from program import write


def kill_once(subject, ricochet, folder, target, phase, chance):
    """In which phase the kill came, and whether mpirun came to its end."""
    at, ranks = TARGETS[target]
    before = set(finished_tasks(folder))
    run, there = subject.reach(ricochet, folder, ranks, phase, chance)
    if not there:
        run.end(60)
        return f"ended before {phase}", True
    met, finished = run.phase(), set(finished_tasks(folder))
    at(run, KILL)
    ended = run.end_of_killed()
    there = (folder / "s.h5").exists()  # then the checkpoint may be gone
    assert there or before <= finished <= set(finished_tasks(folder)), "finished tasks are lost"
    return f"killed in {met}", ended


def kill_runs(subject, target, phase, number):
    def trial(ricochet, folder):
        chance = chance_of(f"{subject.name} {target} {phase}")
        write(folder, "s.yaml", subject.text)
        kills = [kill_once(subject, ricochet, folder, target, phase, chance)]
        if number % 3 == 0:
            kills.append(kill_once(subject, ricochet, folder, target, chance.choice(PHASES), chance))
        finished = finished_tasks(folder)
        subject.expect_resumed(ricochet, folder, chance.choice((0, 1, 2, 3)), finished)
        said = f"{', '.join(words for words, _ in kills)}; {len(finished)} of {subject.tasks} tasks resumed"
        if not all(ended for _, ended in kills):
            raise Known(f"mpirun (Open MPI 4.1) did not end by itself; {said}")
        return said

    return trial


def trials(ricochet):
    subjects = [Subject(kind, study_of(ricochet, kind)) for kind in kinds_of(ricochet, ricochet.new_folder())]
    for subject in subjects:
        subject.prepare(ricochet)
    cases = [(s, target, phase) for phase in PHASES for target in TARGETS for s in subjects]
    return [
        Trial(f"{s.name} {phase} {target}", kill_runs(s, target, phase, number), limit=180)
        for number, (s, target, phase) in enumerate(cases)
    ]
