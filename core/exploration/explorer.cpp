#include "core/exploration/explorer.h"
