#pragma once

#include <filesystem>
#include <string>
#include <type_traits>
#include <utility>

#include "voqcal/module_status_t.hpp"

namespace voqcal {

/// "host:folder": tells one session from another on one network, also of another host. Without a
/// folder "host:".
std::string SessionName(const std::filesystem::path& session_dir);

/// Whether what session `other` says may be taken by `own`: they are the same, or one is a pair's
/// folder within the other (a rig of several sensors), or one of them is none.
bool MayBeOf(const std::string& own, const std::string& other);

template <typename Message, typename = void>
struct HasSession : std::false_type {};
template <typename Message>
struct HasSession<Message, std::void_t<decltype(std::declval<const Message&>().session)>>
    : std::true_type {};
/// Every session's heartbeats are heard: they tell of a second one.
template <>
struct HasSession<module_status_t> : std::false_type {};

/// The session that a message names; empty if its type names none.
template <typename Message>
std::string SessionOf(const Message& message) {
  if constexpr (HasSession<Message>::value) {
    return message.session;
  } else {
    return "";
  }
}

}  // namespace voqcal
