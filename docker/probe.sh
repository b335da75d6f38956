#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Healthcheck of the service's container: succeeds if GET /readyz on the port $1 (8080) is 200. The
# image has no program for HTTP; bash can open a connection.
exec 3<>"/dev/tcp/127.0.0.1/${1:-8080}" || exit 1
printf 'GET /readyz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' >&3
read -r -t 3 _ status _ <&3 && [ "$status" = 200 ]
