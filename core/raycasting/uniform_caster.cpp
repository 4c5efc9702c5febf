#include "core/raycasting/uniform_caster.h"
