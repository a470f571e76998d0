# SPDX-License-Identifier: Apache-2.0
# Functions of what packages_test.py runs in a container with systemd. Facts, "name value", go to /facts, all the rest to /log.
exec >/log 2>&1
set -x
export DEBIAN_FRONTEND=noninteractive

# The units have a /proc of their own, in which the container's boot id, which systemd-nspawn mounts, is that of the machine. Rings
# name it, so all must see the same.
umount /proc/sys/kernel/random/boot_id

fact() { echo "$1 ${*:2}" >>/facts; }

# as_user VERB...: `handcast VERB` as a technician calls it.
as_user() { runuser -u handcast -- handcast "$@"; }

frames() {
  as_user status --rig show --json | python3 -c '
import json, sys
print(json.load(sys.stdin)["rings"]["projection.frames"]["count"])' 2>/dev/null || echo 0
}

# more_than N: waits until so many frames have been cast; fails after 30 s.
more_than() {
  local deadline=$((SECONDS + 30))
  until [ "$(frames)" -gt "$1" ]; do [ $SECONDS -lt $deadline ] || return 1; done
}

lives() { if more_than "$(frames)"; then echo yes; else echo no; fi; }

main_pid() { systemctl show handcast@show --property=MainPID --value; }

# The pids of all services, in the order of their names.
service_pids() {
  as_user status --rig show --json | python3 -c '
import json, sys
print(*(service["pid"] for service in json.load(sys.stdin)["services"].values()))'
}

# seconds_until_light: from the start of the unit's command until all that makes light is ready, by the times in the log.
seconds_until_light() {
  more_than 0 || echo "no light after"
  journalctl --sync
  journalctl --unit handcast@show --output cat |
    awk -v start_us="$(systemctl show handcast@show --property=ExecMainStartTimestampMonotonic --value)" '
      $1 > start_us / 1e6 && $2 ~ /^(camera|pose|landmarks|content|projector)$/ && $4 == "ready" { ready = $1 }
      END { printf "%.2f\n", ready - start_us / 1e6 }'
}
