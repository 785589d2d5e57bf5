"""Tables of reference values: comments, one line that names the columns, one row of comma separated fields a line."""
import pathlib

import mpmath


def text(field, digits):
    """A field as text: words and integers as they are, mpmath numbers to so many digits, floats to 17."""
    if isinstance(field, (str, int)):
        return str(field)
    if isinstance(field, mpmath.mpf):
        return mpmath.nstr(field, digits, min_fixed=-5, max_fixed=8) if mpmath.isfinite(field) else "nan"
    return repr(float(field))


def write(script, name, comments, columns, rows, digits=20):
    """Writes name.csv next to the script."""
    path = pathlib.Path(script).resolve().parent / f"{name}.csv"
    with open(path, "w", encoding="utf-8") as out:
        for line in comments.strip().splitlines():
            out.write(f"# {line}".rstrip() + "\n")
        out.write(f"# {','.join(columns)}\n")
        for row in rows:
            assert len(row) == len(columns), row
            out.write(",".join(text(field, digits) for field in row) + "\n")
    print(f"{path.name}: {len(rows)} rows")
