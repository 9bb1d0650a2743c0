// A rig file.
#include "files/yaml_reader.hpp"
#include "fuzz/fuzz_input.hpp"
#include "rig/rig_sections.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text = voqcal::fuzz::Input(data, size).Text();
  voqcal::fuzz::Tolerate([&text] {
    voqcal::YamlDocument document("rig.yaml", text);
    voqcal::Rig rig;
    voqcal::ReadRigSections({"rig.yaml", {}}, &document, &rig);
    document.ThrowIfWrong();
  });
  return 0;
}
