// replay CORPUS NUM_CHANGES: every kept input, and so many copies of them with a few bytes changed,
// cut or doubled. The same copies each time.
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/simulation/keyed_noise.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> ReadCorpus(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry);
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> corpus;
  for (const auto& path : paths) {
    std::ifstream file(path, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return corpus;
}

// Even numbers from 0 to n - 1, one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : state_(voqcal::MixBits(seed)) {}
  std::size_t Below(std::size_t n) { return voqcal::MixBits(++state_) % n; }

 private:
  std::uint64_t state_;
};

// Values at which counts, lengths and signs go wrong.
constexpr std::uint8_t kTelling[] = {0x00, 0x01, 0x7F, 0x80, 0xFE, 0xFF, '-', '0', '9', '\n'};

void ChangeOnce(Draw* draw, Bytes* bytes) {
  if (bytes->empty()) return;
  const std::size_t at = draw->Below(bytes->size());
  const std::size_t run = 1 + draw->Below(std::min<std::size_t>(8, bytes->size() - at));
  const auto begin = bytes->begin() + static_cast<std::ptrdiff_t>(at);
  const auto end = begin + static_cast<std::ptrdiff_t>(run);
  switch (draw->Below(5)) {
    case 0:
      *begin ^= static_cast<std::uint8_t>(1 << draw->Below(8));
      break;
    case 1:
      std::fill(begin, end, kTelling[draw->Below(std::size(kTelling))]);
      break;
    case 2:
      bytes->erase(begin, end);
      break;
    case 3: {
      const Bytes doubled(begin, end);
      bytes->insert(begin, doubled.begin(), doubled.end());
      break;
    }
    default:
      if (draw->Below(8) == 0) bytes->resize(at);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s CORPUS NUM_CHANGES\n", argv[0]);
    return 2;
  }
  const std::vector<Bytes> corpus = ReadCorpus(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no inputs in %s\n", argv[0], argv[1]);
    return EXIT_FAILURE;
  }
  for (const Bytes& bytes : corpus) LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  const int num_changes = std::atoi(argv[2]);
  for (int i = 0; i < num_changes; ++i) {
    Draw draw(static_cast<std::uint64_t>(i));
    Bytes bytes = corpus[draw.Below(corpus.size())];
    const std::size_t num_steps = 1 + draw.Below(4);
    for (std::size_t step = 0; step < num_steps; ++step) ChangeOnce(&draw, &bytes);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%zu inputs and %d changed copies\n", corpus.size(), num_changes);
}
