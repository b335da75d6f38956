// SPDX-License-Identifier: GPL-3.0-or-later
//
// The stream of bytes from and to a client: TCP, or TLS over it. Includes Asio: for the transport
// only.
#pragma once

#include <utility>  // before Asio: Boost 1.74 uses std::exchange without including it

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <memory>
#include <optional>
#include <string>

#include "base/result.h"

namespace watertight::server {

using TlsContext = boost::asio::ssl::context;

/// The settings of TLS: versions 1.2 and 1.3, with a certificate (chain) and its key as PEM texts.
/// Errors: invalid_argument for texts that are no certificate or key, or do not belong together.
Result<std::shared_ptr<TlsContext>> make_tls(const std::string& certificate,
                                             const std::string& key);

/// Models Beast's asynchronous streams.
class ClientStream {
 public:
  using executor_type = boost::beast::tcp_stream::executor_type;

  /// `tls` is null for plain TCP; it must outlive the stream.
  ClientStream(boost::asio::ip::tcp::socket socket, TlsContext* tls) : tcp_(std::move(socket)) {
    if (tls != nullptr) tls_.emplace(tcp_, *tls);
  }
  ClientStream(const ClientStream&) = delete;
  ClientStream& operator=(const ClientStream&) = delete;

  executor_type get_executor() noexcept { return tcp_.get_executor(); }
  boost::asio::ip::tcp::socket& socket() { return tcp_.socket(); }

  template <class Duration>
  void expires_after(Duration duration) {
    tcp_.expires_after(duration);
  }
  void expires_never() { tcp_.expires_never(); }
  void cancel() { tcp_.cancel(); }
  void close() { tcp_.close(); }

  bool is_encrypted() const { return tls_.has_value(); }
  /// Agrees on keys with the client; at once without TLS. False if that failed.
  boost::asio::awaitable<bool> handshake();
  /// Tells the client that nothing more will be sent. The time limit of the stream holds.
  boost::asio::awaitable<void> end_sending();

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return tls_ ? tls_->async_read_some(buffers, std::forward<Token>(token))
                : tcp_.async_read_some(buffers, std::forward<Token>(token));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return tls_ ? tls_->async_write_some(buffers, std::forward<Token>(token))
                : tcp_.async_write_some(buffers, std::forward<Token>(token));
  }

 private:
  boost::beast::tcp_stream tcp_;
  std::optional<boost::beast::ssl_stream<boost::beast::tcp_stream&>> tls_;
};

}  // namespace watertight::server
