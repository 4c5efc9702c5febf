#include "core/motion/collision_grid.h"
