#include "dashboard/request.hpp"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

namespace voqcal {
namespace {

using Json = nlohmann::json;

constexpr std::array<const char*, 4> kCommands = {"capture", "discard", "finish", "reset"};

Expected<PageRequest, std::string> ReadShown(const Json& json) {
  if (json.size() != 1) return std::string("\"shown\" stands alone");
  for (const Slot slot : {Slot::kImage, Slot::kCloud}) {
    if (json["shown"] != ToString(slot)) continue;
    PageRequest request;
    request.shown = slot;
    return request;
  }
  return std::string("\"shown\" must be \"image\" or \"cloud\"");
}

Expected<PageRequest, std::string> ReadWatch(const Json& json) {
  PageRequest request;
  if (json.size() == 1 && json["watch"].is_string()) {
    request.watch = json["watch"].get<std::string>();
  }
  if (request.watch.empty()) return std::string("\"watch\" is the name of a pair and stands alone");
  return request;
}

Expected<PageRequest, std::string> ReadCommand(const Json& json) {
  PageRequest request;
  if (json["command"].is_string()) request.command = json["command"].get<std::string>();
  if (std::find(kCommands.begin(), kCommands.end(), request.command) == kCommands.end()) {
    return std::string("\"command\" must be \"capture\", \"discard\", \"finish\" or \"reset\"");
  }
  const bool has_sample = json.contains("sample_id");
  const bool has_pair = json.contains("pair");
  if (json.size() != 1U + (has_sample ? 1U : 0U) + (has_pair ? 1U : 0U)) {
    return std::string("unknown keys beside \"command\"");
  }
  if (has_pair) {
    if (json["pair"].is_string()) request.pair = json["pair"].get<std::string>();
    if (request.pair.empty()) return std::string("\"pair\" is the name of a pair");
  }
  if (!has_sample) return request;
  // Beyond 2^53 JavaScript's numbers are not exact.
  constexpr std::uint64_t kMaxId = std::uint64_t{1} << 53U;
  const Json& id = json["sample_id"];
  const bool is_id = id.is_number_unsigned() && id.get<std::uint64_t>() <= kMaxId;
  if (request.command != "discard" || !is_id) {
    return std::string("\"sample_id\" is the whole number of the sample to discard");
  }
  request.sample_id = id.get<std::int64_t>();
  return request;
}

}  // namespace

Expected<PageRequest, std::string> ParsePageRequest(std::string_view text) {
  if (text.size() > kMaxRequestBytes) return std::string("the request is too long");
  const Json json = Json::parse(text, nullptr, false);
  if (json.is_discarded()) return std::string("the request is no JSON");
  if (!json.is_object()) return std::string("the request is no JSON object");
  if (json.contains("shown")) return ReadShown(json);
  if (json.contains("watch")) return ReadWatch(json);
  if (json.contains("command")) return ReadCommand(json);
  return std::string("the request has none of \"command\", \"watch\" and \"shown\"");
}

}  // namespace voqcal
