#pragma once

#include "core/lidar_packets/beam_table.hpp"

namespace voqcal {

// Angles by channel, where no unit's own file is given (hesai.hpp says where they come from).
BeamTable Hesai40pBeams();
BeamTable Hesai64Beams();
BeamTable HesaiQt64Beams();
BeamTable HesaiQt128Beams();
BeamTable HesaiXt16Beams();
BeamTable HesaiXt32Beams();
BeamTable HesaiXt32mBeams();
BeamTable HesaiOt128Beams();

}  // namespace voqcal
