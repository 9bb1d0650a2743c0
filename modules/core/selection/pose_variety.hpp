#pragma once

#include <string>
#include <vector>

#include "core/board/board_sample.hpp"

namespace voqcal {

/// Why the poses of these boards cannot hold an extrinsic, however well each of them is seen, as a
/// sentence for who moves the board: too few, all parallel, all at one place, all on one line.
/// Empty if they can. It is judged by the camera's poses, which are the better ones.
std::string VarietyProblem(const std::vector<const BoardSample*>& samples);

}  // namespace voqcal
