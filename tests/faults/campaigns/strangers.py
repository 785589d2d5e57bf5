"""Results that somebody forged: bytes of their metadata changed, and the checksums made right. However HDF5 crashes on
them, `show`, `show --csv` and `show --verify` end in a sentence. A trial is 25 forged results of one kind."""

from itertools import islice

from campaign import Trial
from forged import look, mutants

from program import coarser

STUDIES = ("table", "bouncing_chain", "impact_branch", "grazing_regimes", "basin")  # one of every shape of result
TRIALS = 20  # of each


def forge(path, data, seed):
    def run(ricochet, folder):
        found = [look(ricochet, folder, *mutant) for mutant in islice(mutants(data, f"{path.stem} {seed}"), 25)]
        return f"{sum(found)} of {3 * len(found)} readings crashed in HDF5"

    return run


def trials(ricochet):
    for name in STUDIES:
        path, folder = ricochet.studies / f"{name}.yaml", ricochet.new_folder()
        ricochet.run(path, *coarser(path), cwd=folder).expect_done()
        data = (folder / f"{name}.h5").read_bytes()
        for seed in range(TRIALS):
            yield Trial(f"{name} {seed}", forge(path, data, seed), limit=180)
