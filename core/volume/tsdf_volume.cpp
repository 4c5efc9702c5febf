#include "core/volume/tsdf_volume.h"
