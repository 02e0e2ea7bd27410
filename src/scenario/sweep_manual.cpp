// The section on [sweep] of docs/scenario.md.
#include "scenario/sweep_manual.h"

namespace palpate::scenario {

std::string sweep_manual() {
  return R"(
## `[sweep]`

Makes a family of cases. Any key of this manual can be swept by its dotted path: `"finger.radius"`, `"step.1.to"`, entries of lists such as `"tissue.shape.size.3"`, and whole tables such as `"tissue.shape"`. `palpate run` takes up to 1000 cases, `palpate sweep` any number.

```toml
[sweep]                     # every value with every other
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", points = 20, scale = "log" }
```

A key has a list of values, or a range. A range includes both ends, which are written in the same unit. In a grid it has `points` values (at least 2), spaced evenly, or with `scale = "log"` evenly in their logarithms. Values between the ends are rounded to 12 digits in the unit of the range: `3.16227766017 kPa`. Keys with whole numbers need a list, unless all points of a range are whole.

| key | value | default | meaning |
| --- | --- | --- | --- |
| `design` | a word below | `grid` | Which cases are made. |
| `samples` | whole number >= 1 and <= 10000000 |  | With `lhs`, `sobol` and `saltelli`: required. |
| `seed` | whole number >= 0 | `1` | With `lhs`. |
| `file` | text |  | With `csv`: the table's path, from the scenario's folder. Required. |

| design | cases |
| --- | --- |
| `grid` | Every value with every other; the last key varies fastest. |
| `list` | The first values of all keys, then the second ones, and so on: lists of one length. |
| `csv` | One case per row of a table. |
| `lhs` | A Latin hypercube: each range is divided into `samples` equal parts, each of which contains one case, at a random place. |
| `sobol` | The Sobol sequence, which fills the space more evenly; its first point, the origin, is left out, and nothing is scrambled. Most even with 2^k - 1 `samples`. |
| `saltelli` | For first-order and total Sobol indices: of `d` keys, `samples` times d + 2 cases. Two independent points A and B of a Sobol sequence in 2 d dimensions, then A with one key of B after the other: A, B, A_B^1 ... A_B^d. |

In the last three designs a key has a range without `points`, or a list whose values get equal shares of the cases. A Latin hypercube is drawn by the 64-bit Mersenne twister of the C++ standard, the same on every machine: for one key after the other, first the order of its parts, by exchanging the last with one drawn before it or itself and so on down to the second, then a place in each from the upper 29 bits of a number.

```toml
[sweep]
design  = "lhs"
samples = 200
seed    = 1
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", scale = "log" }
"tissue.poisson_ratio" = { from = 0.2, to = 0.49 }
"finger.material"      = ["finger", "rigid"]
```

Keys that change together, such as a tissue and its properties, are written in a `[[sweep.rows]]` table, as lists of the same length. They count as one key in every design. There may be several such tables.

```toml
[sweep]
"finger.radius" = ["8 mm", "11 mm"]
[[sweep.rows]]
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = ["60 kPa", "20 kPa"]
```

A table has one column per key and one row per case. Its header names the keys, with a unit if the numbers need one. Cells are separated by commas, and quoted if they contain a comma.

```csv
tissue.young_modulus [kPa],tissue.poisson_ratio,tissue.material,step.1.to
12.5,0.4,skin,1 mm
80,0.45,muscle,2 mm
```

Cases are named by their values, joined by `_`. If there are more than 1000 cases, if a name would be longer than 80 letters, and in samples and tables, they are named by their number, `0001`.

These are refused before the first case runs: ends of a range outside a key's limits, a key that no case reads because the chosen model does not use it, two values of one key that make the same case, and everything that is refused in a scenario.
)";
}

}  // namespace palpate::scenario
