// The texts that `palpate new` writes. Each runs as it is; a test runs them all.
#include "scenario/starters.h"

#include <array>

namespace palpate::scenario {
namespace {

// The first line makes editors with Taplo check the file against `palpate schema >
// palpate.schema.json`.
constexpr std::string_view press = R"(#:schema ./palpate.schema.json
# A finger presses flat tissue, waits and withdraws.
#   palpate explain press.toml      which model would be used, and how far to trust it
#   palpate run press.toml          writes out/press/
#   palpate explain step.to         what a key means; all other keys have defaults
schema = 1
title  = "A finger presses skin"

[tissue]
material = "skin"              # or muscle, ligament, bone, upper_leg, or "own.toml#name"
# young_modulus = "20 kPa"     # instead of the material's

[finger]
radius = "11 mm"

[[step]]
kind = "indent"
to   = "2 mm"                  # a displacement, or a force such as "0.5 N"
rate = "5 mm/s"

[[step]]
kind = "hold"
time = "1 s"

[[step]]
kind = "retract"
to   = "0 mm"
rate = "5 mm/s"

[output]
interval = "20 ms"             # between rows
)";

constexpr std::string_view creep = R"(#:schema ./palpate.schema.json
# A constant stress on the ends of a block, then recovery: strain over time.
schema = 1
title  = "Creep of skin"

[tissue]
material            = "skin"
shape               = { kind = "cuboid", size = ["20 mm", "20 mm", "10 mm"] }
viscosity           = "standard_linear_solid"   # or kelvin_voigt, prony; kelvin_voigt creeps from zero
relaxation_time     = "0.5 s"                   # at constant strain
instantaneous_ratio = 2.0                       # instantaneous over relaxed modulus

[[step]]
kind          = "creep"
stress        = "500 Pa"
load_time     = "3 s"
recovery_time = "3 s"

[output]
interval = "50 ms"
)";

constexpr std::string_view compress = R"(#:schema ./palpate.schema.json
# A block between slippery platens is shortened at a constant rate, then held: stress over strain.
schema = 1
title  = "Compression of a phantom"

[tissue]
young_modulus      = "15 kPa"
poisson_ratio      = 0.45
shape              = { kind = "cuboid", size = ["20 mm", "20 mm", "10 mm"] }
base               = "frictionless"    # `bonded`: the lower platen holds the block
viscosity          = "standard_linear_solid"
relaxation_time    = "2 s"
instantaneous_ratio = 1.4

[[step]]
kind      = "compress"
strain    = 0.1
rate      = "0.05 1/s"         # the platen's speed over the height
hold_time = "5 s"

[output]
interval = "20 ms"
)";

constexpr std::string_view relax = R"(#:schema ./palpate.schema.json
# A constant strain of a block: stress over time, with a Prony series.
schema = 1
title  = "Relaxation of muscle"

[tissue]
material  = "muscle"
shape     = { kind = "cuboid", size = ["20 mm", "20 mm", "10 mm"] }
viscosity = "prony"

[[tissue.branch]]              # repeat for more branches
relaxation_time = "0.2 s"
ratio           = 0.8          # its modulus over that of the relaxed tissue
[[tissue.branch]]
relaxation_time = "2 s"
ratio           = 0.4

[[step]]
kind   = "relax"
strain = 0.02
time   = "5 s"

[output]
interval = "50 ms"
)";

constexpr std::string_view organ = R"(#:schema ./palpate.schema.json
# A body with a stiff inclusion, pressed from above. Give your own surface or mesh in place of the ellipsoid,
# or a punch of tissue, shape = { kind = "disc", radius = "6 mm", height = "5 mm" }:
#   shape = { file = "organ.stl", unit = "mm" }      a closed surface: .stl .obj .ply .off
#   mesh  = { file = "organ.msh", unit = "mm" }      tetrahedra: .msh of Gmsh, .node of TetGen; its
#                                                    parts are `tagged` regions in place of the sphere
# `palpate convert organ.stl --unit mm` checks such a file; z points up.
schema = 1
title  = "An organ with an inclusion"

[tissue]
material      = "muscle"
young_modulus = "5 kPa"
shape         = { kind = "ellipsoid", size = ["80 mm", "60 mm", "40 mm"] }
mesh          = { kind = "tetgen", nodes = 1500 }

[[region]]
kind          = "sphere"
centre        = ["40 mm", "30 mm", "28 mm"]    # from the lowest corner; of a file: its own coordinates
radius        = "7 mm"
young_modulus = "50 kPa"

[finger]
radius = "8 mm"

[[step]]
kind = "indent"
to   = "2 mm"
rate = "5 mm/s"

[output]
interval = "50 ms"
)";

constexpr std::string_view sweep = R"(#:schema ./palpate.schema.json
# One case for every value with every other. `palpate run` takes up to 1000 cases, `palpate sweep` any
# number, which can be interrupted and divided among machines:
#   palpate sweep plan sweep.toml
#   palpate sweep run out/sweep_sweep
#   palpate sweep merge out/sweep_sweep
schema = 1
title  = "Stiffness and thickness"

[tissue]
material = "skin"
shape    = { kind = "cuboid", size = ["100 mm", "100 mm", "20 mm"] }

[[step]]
kind = "indent"
to   = "1 mm"
rate = "5 mm/s"

[output]
interval      = "50 ms"
pressure_maps = false

[sweep]
"tissue.young_modulus" = { from = "5 kPa", to = "80 kPa", points = 5, scale = "log" }
"tissue.shape.size.3"  = ["10 mm", "20 mm"]
)";

constexpr std::string_view live = R"(#:schema ./palpate.schema.json
# A test stand presses a specimen, and the model beside it computes the same press.
#   palpate run live.toml                                        the model alone
#   palpate device probe mark10:/dev/ttyUSB0                     what is connected; nothing moves
#   palpate run live.toml --device mark10:/dev/ttyUSB0           observes
#   palpate run live.toml --device mark10:/dev/ttyUSB0 --arm     moves the stand
# palpate-emulator plays a stand without hardware.
schema = 1
title  = "A stand presses skin"

[tissue]
material = "skin"
shape    = { kind = "half_space" }

[finger]
material = "rigid"
radius   = "5 mm"

[contact]
depth = "hertz"

[solver]
model = "hertz"                # must keep the pace of the device

[[step]]
kind = "indent"
to   = "1 mm"
rate = "2 mm/s"

[[step]]
kind = "hold"
time = "0.5 s"

[[step]]
kind = "retract"
to   = "0 mm"
rate = "2 mm/s"

[output]
interval      = "20 ms"
pressure_maps = false
)";

constexpr std::array all{
    Starter{{"press", "a finger presses, waits and withdraws"}, press},
    Starter{{"creep", "a constant stress: strain over time"}, creep},
    Starter{{"relax", "a constant strain: stress over time"}, relax},
    Starter{{"compress", "a strain that grows: stress over strain"}, compress},
    Starter{{"organ", "a body of its own shape, with a stiff inclusion"}, organ},
    Starter{{"sweep", "a family of cases"}, sweep},
    Starter{{"live", "a press by a test stand"}, live},
};

}  // namespace

std::span<const Starter> starters() { return all; }

}  // namespace palpate::scenario
