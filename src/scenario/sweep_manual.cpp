// What [sweep] can say, for docs/scenario.md.
#include "scenario/sweep_manual.h"

namespace palpate::scenario {

std::string sweep_manual() {
  return R"(
## `[sweep]`

Makes a family of cases. Any key of this manual can be swept, by its dotted path: `"finger.radius"`, `"step.1.to"`, whole tables such as `"tissue.shape"` too. `palpate run` takes up to 1000 cases, `palpate sweep` any number.

```toml
[sweep]                     # every value with every other
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", points = 20, scale = "log" }
```

A key has a list of values, or a range. Both ends of a range belong to it and are written in one unit; `points` (a grid's, 2 at least) lie evenly between them, or evenly in their logarithms with `scale = "log"`. Values between the ends are written in the range's unit with 12 digits, and that text is the value: `3.16227766017 kPa`. Whole numbers want a list, unless the points of a range are whole.

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
| `csv` | A row of a table each. |
| `lhs` | A Latin hypercube: of as many equal parts of each range as there are `samples`, each holds one case, at a place drawn inside it. |
| `sobol` | The Sobol sequence, which fills the space more evenly; its first point, the origin, is left out, and nothing is scrambled. Most even with 2^k - 1 `samples`. |
| `saltelli` | For first-order and total Sobol indices: of `d` keys, `samples` times d + 2 cases. Two independent points A and B of a Sobol sequence in 2 d dimensions, then A with one key of B after the other: A, B, A_B^1 ... A_B^d. |

In the last three a key has a range without `points`, or a list from which the sample chooses evenly. A Latin hypercube is drawn by the 64-bit Mersenne twister of the C++ standard, the same on every machine: for one key after the other, first the order of its parts, by exchanging the last with one drawn before it or itself and so on down to the second, then a place in each from the upper 29 bits of a number.

```toml
[sweep]
design  = "lhs"
samples = 200
seed    = 1
"tissue.young_modulus" = { from = "1 kPa", to = "100 kPa", scale = "log" }
"tissue.poisson_ratio" = { from = 0.2, to = 0.49 }
"finger.material"      = ["finger", "rigid"]
```

Keys that change together, such as tissues with all that belongs to them, stand in a `[[sweep.rows]]`: lists of one length, which count as one key in every design. There may be several.

```toml
[sweep]
"finger.radius" = ["8 mm", "11 mm"]
[[sweep.rows]]
"tissue.material"      = ["skin", "muscle"]
"tissue.young_modulus" = ["60 kPa", "20 kPa"]
```

A table has a column a key and a row a case. Its header names keys, with a unit where numbers need one; cells are separated by commas and quoted where they hold one.

```csv
tissue.young_modulus [kPa],tissue.poisson_ratio,tissue.material,step.1.to
12.5,0.4,skin,1 mm
80,0.45,muscle,2 mm
```

Cases are named by their values, joined by `_`; where there are more than 1000, where names would be longer than 80 letters, and in samples and tables, by their number, `0001`.

Refused before the first case runs: ends of a range that leave a key's limits, a key that no case reads because the chosen model has no use for it, two values of one key that make the same case, and everything that is refused in a scenario.
)";
}

}  // namespace palpate::scenario
