#!/bin/bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Healthcheck of the service's container: succeeds if GET /readyz on the port $1 is 200; without $1,
# on port 8081, that of the probes, or on 8080 if none listens there. The image has no program for
# HTTP; bash can open a connection.
connect() { exec 3<>"/dev/tcp/127.0.0.1/$1"; } 2>/dev/null
if [ $# -gt 0 ]; then
  connect "$1" || exit 1
else
  connect 8081 || connect 8080 || exit 1
fi
printf 'GET /readyz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n' >&3
read -r -t 3 _ status _ <&3 && [ "$status" = 200 ]
