// Twenty scenes for `model = "auto"`: from bone to a limb with a lump, slow, fast, deep, narrow.
#pragma once

#include <string>
#include <vector>

namespace palpate::test {

struct AutoScene {
  const char* name;
  const char* text;
};

inline const std::vector<AutoScene>& auto_scenes() {
  static const std::vector<AutoScene> scenes = {
      {"bone under a silicone finger",
       "[tissue]\nmaterial = \"bone\"\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"},
      {"muscle without end",
       "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"half_space\" }\n[[step]]\nkind = "
       "\"indent\"\nto = \"1 mm\"\n"},
      {"thick muscle",
       "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"cuboid\", size = [\"400 mm\", \"400 "
       "mm\", \"300 mm\"] }\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"skin 30 mm thick", "[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"skin 10 mm thick",
       "[tissue]\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"10 mm\"] "
       "}\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"thin skin",
       "[tissue]\nshape = { kind = \"cuboid\", size = [\"60 mm\", \"60 mm\", \"3 mm\"] "
       "}\n[[step]]\nkind = \"indent\"\nto = \"0.3 mm\"\n"},
      {"ligament that slides on its base",
       "[tissue]\nmaterial = \"ligament\"\nbase = \"frictionless\"\nshape = { kind = \"cuboid\", "
       "size = [\"60 mm\", \"60 mm\", \"8 mm\"] }\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"},
      {"a narrow block",
       "[tissue]\nshape = { kind = \"cuboid\", size = [\"25 mm\", \"25 mm\", \"30 mm\"] "
       "}\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"beside a side", "[finger]\nx = \"8 mm\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"a wide cylinder",
       "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"cylinder\", radius = \"60 mm\", length "
       "= \"200 mm\" }\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"},
      {"a thin cylinder",
       "[tissue]\nshape = { kind = \"cylinder\", radius = \"12 mm\", length = \"60 mm\" "
       "}\n[[step]]\nkind = \"indent\"\nto = \"0.5 mm\"\n"},
      {"an ellipsoid",
       "[tissue]\nmaterial = \"muscle\"\nshape = { kind = \"ellipsoid\", size = [\"80 mm\", \"100 "
       "mm\", \"60 mm\"] }\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\n"},
      {"a curved ligament",
       "[tissue]\nmaterial = \"ligament\"\nshape = { kind = \"ligament\" }\n[[step]]\nkind = "
       "\"indent\"\nto = \"1 mm\"\n"},
      {"a lump under the skin",
       "[tissue]\nmesh = { kind = \"tetgen\", nodes = 1500 }\n[[region]]\nkind = "
       "\"sphere\"\nradius = \"5 mm\"\ncentre = [\"30 mm\", \"30 mm\", \"20 "
       "mm\"]\nmaterial = \"skin\"\nyoung_modulus = \"1 MPa\"\n[[step]]\nkind = \"indent\"\nto = "
       "\"1 mm\"\n"},
      {"a layered limb",
       "[tissue]\nshape = { kind = \"layered_limb\" }\n[[step]]\nkind = \"indent\"\nto = \"1 "
       "mm\"\n"},
      {"a fast tap",
       "[tissue]\nviscosity = \"none\"\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"300 "
       "mm/s\"\n[output]\ninterval = \"0.1 ms\"\n"},
      {"a slow press of a solid that relaxes",
       "[tissue]\nviscosity = \"standard_linear_solid\"\nshape = { kind = \"half_space\" "
       "}\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"0.001 mm/s\"\n[output]\ninterval = "
       "\"10 s\"\n"},
      {"a quick press of a solid that relaxes",
       "[tissue]\nviscosity = \"standard_linear_solid\"\nshape = { kind = \"cuboid\", size = [\"60 "
       "mm\", \"60 mm\", \"10 mm\"] }\n[[step]]\nkind = \"indent\"\nto = \"1 mm\"\nrate = \"5 "
       "mm/s\"\n"},
      {"a deep press",
       "[tissue]\npoisson_ratio = 0.45\nshape = { kind = \"half_space\" }\n[[step]]\nkind = "
       "\"indent\"\nto = \"5 mm\"\n"},
      {"slow creep of a block on a bonded base",
       "[tissue]\nmaterial = \"ligament\"\nbase = \"bonded\"\n[[step]]\nkind = \"creep\"\nstress = "
       "\"0.5 kPa\"\nload_time = \"2 s\"\n"},
      {"slow creep between slippery platens",
       "[tissue]\nmaterial = \"ligament\"\n[[step]]\nkind = \"creep\"\nstress = \"0.5 "
       "kPa\"\nload_time = \"2 s\"\n"},
  };
  return scenes;
}

}  // namespace palpate::test
