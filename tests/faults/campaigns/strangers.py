"""Results that somebody forged: bytes of their metadata changed, and the checksums made right. However HDF5 crashes on
them, `show`, `show --csv` and `show --verify` end in a sentence. A trial is 25 forged results of one kind."""

from itertools import islice

from campaign import Trial
from forged import look, mutants

from program import coarser

STUDIES = ("table", "bouncing_chain", "impact_branch", "grazing_regimes", "basin")  # one of every shape of result
TRIALS = 20  # of each


def forge(name, data, seed):
    def run(ricochet, folder):
        found = [look(ricochet, folder, *mutant) for mutant in islice(mutants(data, f"{name} {seed}"), 25)]
        return f"{sum(found)} of {3 * len(found)} readings crashed in HDF5"

    return run


def result_of(ricochet, name):
    path, folder = ricochet.studies / f"{name}.yaml", ricochet.new_folder()
    ricochet.run(path, *coarser(path), cwd=folder).expect_done()
    return (folder / f"{name}.h5").read_bytes()


def trials(ricochet):
    results = {name: result_of(ricochet, name) for name in STUDIES}
    return [Trial(f"{name} {seed}", forge(name, data, seed), limit=180)
            for seed in range(TRIALS) for name, data in results.items()]  # fmt: skip
