// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/transport/client_stream.h"

#include <boost/asio/redirect_error.hpp>
#include <boost/asio/use_awaitable.hpp>

#include "server/transport/listener.h"

namespace watertight::server {
namespace {

namespace asio = boost::asio;
using asio::redirect_error;
using asio::use_awaitable;
using boost::system::error_code;

}  // namespace

Result<std::shared_ptr<TlsContext>> make_tls(const std::string& certificate,
                                             const std::string& key) {
  auto context = std::make_shared<TlsContext>(TlsContext::tls_server);
  error_code error;
  context->set_options(TlsContext::default_workarounds | TlsContext::no_sslv2 |
                           TlsContext::no_sslv3 | TlsContext::no_tlsv1 | TlsContext::no_tlsv1_1 |
                           TlsContext::no_compression,
                       error);
  const auto wrong = [&error](const char* what) {
    std::string message(what);
    message.append(": ").append(error.message());
    return Error{ErrorCode::invalid_argument, std::move(message)};
  };
  context->use_certificate_chain(asio::buffer(certificate), error);
  if (error) return wrong("the certificate is no chain of certificates in PEM");
  context->use_private_key(asio::buffer(key), TlsContext::pem, error);
  if (error)
    return wrong("the key is no key in PEM without a pass phrase that fits the certificate");
  return context;
}

Status check_tls(const std::string& certificate, const std::string& key) {
  const auto made = make_tls(certificate, key);
  return made ? Status(Done{}) : made.error();
}

asio::awaitable<bool> ClientStream::handshake() {
  if (!tls_) co_return true;
  error_code error;
  co_await tls_->async_handshake(asio::ssl::stream_base::server,
                                 redirect_error(use_awaitable, error));
  co_return !error;
}

asio::awaitable<void> ClientStream::end_sending() {
  error_code ignored;
  if (tls_) co_await tls_->async_shutdown(redirect_error(use_awaitable, ignored));
  tcp_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
}

}  // namespace watertight::server
