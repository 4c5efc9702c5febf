#include "core/perception/contours.h"
