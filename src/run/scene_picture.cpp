// Faces that one tetrahedron has alone, or that two share whose regions differ.
#include "run/scene_picture.h"

#include "contact/slide.h"
#include "scene/first_touch.h"
