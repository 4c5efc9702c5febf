#include "core/views/contour_views.h"
