#!/bin/bash
# SPDX-License-Identifier: Apache-2.0
# A technician installs handcast, makes a rig, uses it, upgrades, and removes it.
source /in_container.sh

apt-get install -y --no-install-recommends /packages/handcast_*.deb /packages/handcast-tools_*.deb && fact installed yes
fact groups "$(id -nG handcast)"
fact owners "$(stat -c %U:%a /etc/handcast /var/lib/handcast /var/log/handcast | xargs)"

as_user init --yes --camera twin /etc/handcast/show.toml >/tmp/said
fact next_step "$(grep -o 'sudo systemctl.*' /tmp/said)"
sed -i '/^\[\(camera\|projector\)\]/a rate_hz = 60' /etc/handcast/show.toml
systemctl enable --now handcast@show
fact start_to_light_s "$(seconds_until_light)"
fact desk "$(as_user desk | cut -d/ -f1-2)"
as_user set light.master=0.5 && as_user save && fact saved "$(stat -c %U /etc/handcast/show.live.toml)"
install -D /dev/null /var/lib/handcast/show/recordings/first

before=$(main_pid) services=$(service_pids)
dpkg --install /packages/handcast_*.deb /packages/handcast-tools_*.deb
[ "$(main_pid) $(service_pids)" = "$before $services" ] && fact upgraded_under_the_light "$(lives)"
kill -KILL "$before"
until [ "$(main_pid)" != "$before" ] && [ "$(main_pid)" != 0 ]; do sleep 0.1; done
more_than 0
[ "$(service_pids)" = "$services" ] && fact adopted_by_the_next_supervisor "$(lives)"
systemctl restart handcast@show
[ "$(service_pids)" != "$services" ] && fact restarted "$(lives)"

apt-get remove -y handcast-tools handcast && fact removed yes
fact processes_left "$(pgrep -c -u handcast)"
fact left_by_remove "$(ls /etc/handcast | xargs)"
apt-get purge -y handcast >/tmp/said 2>&1
fact left_by_purge "$(find /etc/handcast /var/log/handcast /var/lib/handcast /etc/systemd/system/*.wants/handcast@* 2>/dev/null | xargs)"
fact purge_says "$(grep -o 'recordings are kept.*' /tmp/said)"
apt-get install -y --no-install-recommends /packages/handcast_*.deb
as_user init --yes --camera twin /etc/handcast/show.toml
sed -i '/^\[\(camera\|projector\)\]/a rate_hz = 60' /etc/handcast/show.toml
systemctl enable handcast@show
fact done yes
systemctl poweroff
