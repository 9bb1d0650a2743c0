#pragma once

#include "voqcal/samples_t.hpp"

namespace voqcal {

// Which samples a later stage's message was made from. Revision and hash of the session's log
// together are their identity: a revision alone is a count, which another session or one begun
// anew repeats. `Message` is any type with utime, samples_revision and samples_sha256.

template <typename Message>
bool IsMadeFrom(const samples_t& samples, const Message& message) {
  return message.samples_revision == samples.revision &&
         message.samples_sha256 == samples.log_sha256;
}

template <typename Message>
void StampMadeFrom(const samples_t& samples, Message* message) {
  message->utime = samples.utime;
  message->samples_revision = samples.revision;
  message->samples_sha256 = samples.log_sha256;
}

}  // namespace voqcal
