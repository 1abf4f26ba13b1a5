#include "kinequad/pipeline/version.h"

namespace kinequad {

const char* const version = KINEQUAD_VERSION;

}  // namespace kinequad
