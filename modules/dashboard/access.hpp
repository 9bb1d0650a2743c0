#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace voqcal {

/// 256 bits of the operating system's random source, as 64 hexadecimal digits.
/// @throws std::runtime_error if there is no such source.
std::string NewToken();

/// The token of the addresses that this file holds (SaveAddresses), so that a page that is open
/// goes on when the dashboard was started again; a new one if there is no such file, or if others
/// than its owner may read it.
std::string TokenOfSession(const std::filesystem::path& address_file);

/// Writes the addresses, a line each, whole or not at all, for their owner's eyes only (mode 0600).
/// @throws std::runtime_error naming the file and the cause.
void SaveAddresses(const std::filesystem::path& address_file, const std::string& lines);

/// Equality that takes as long for a good guess as for a bad one.
bool IsSameSecret(std::string_view a, std::string_view b);

/// Whether a request's Host header may name this server: an IP address, "localhost" or `host_name`,
/// with any port. Another name is a page whose name was made to lead here (DNS rebinding).
bool IsOwnHost(std::string_view host, std::string_view host_name);

/// Whether an Origin header is that of the page which this server gave out under this Host.
bool IsOwnOrigin(std::string_view origin, std::string_view host);

}  // namespace voqcal
