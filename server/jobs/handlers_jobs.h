// SPDX-License-Identifier: GPL-3.0-or-later
//
// The upload of a job, which begins before the body of its request is read. Internal to server/.
#pragma once

#include <memory>
#include <string>

#include "server/handlers.h"
#include "server/transport/listener.h"

namespace watertight::server {

/// The most bytes of the file of a job: 256 GiB.
inline constexpr std::uint64_t kLongestJobFile = std::uint64_t{256} << 30U;

/// Begins the upload of the file of a job, or answers at once: with the problem, or with the job
/// that a request with the same Idempotency-Key has made. `owner` is the name of the access key.
Admission begin_job(const RoutedRequest& request, const std::string& owner);

}  // namespace watertight::server
