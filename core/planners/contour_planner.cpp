#include "core/planners/contour_planner.h"
