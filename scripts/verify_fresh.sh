#!/bin/bash
# Makes a bare Debian in a temporary folder, clones the committed tree into it, runs the README's two commands there,
# and proves that a second set-up does nothing and needs no network. Takes root and debootstrap.
#
#   FRESH_SUITE     Debian's release                                   (bookworm)
#   FRESH_COMMANDS  commands to run instead, separated by semicolons   (make demo; make test)
#   FRESH_MIRROR    where debootstrap fetches Debian from              (http://deb.debian.org/debian)
#   FRESH_BIND      more folders of this host to show read-only inside
#   FRESH_KEEP      set: leave the folder there
# This host's name resolution, certificates, and configuration of apt and pip (files and PIP_* variables) are copied, and
# folders that pip is told to look into, such as a local index, are shown inside.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
inside=/home/riser_soil
suite=${FRESH_SUITE:-bookworm}
commands=${FRESH_COMMANDS:-make demo; make test}
config=${XDG_CONFIG_HOME:-$HOME/.config}

main() {
    if [ "${1:-}" = --inside ]; then
        mount_and_run "$2"
        return
    fi
    [ "$(id -u)" -eq 0 ] || fail "needs root, for debootstrap and chroot"
    command -v debootstrap >/dev/null || fail "needs debootstrap: apt-get install debootstrap"
    git -C "$root" diff --quiet HEAD || echo "verify-fresh: uncommitted changes are not part of what is tested" >&2
    fresh=$(mktemp -d "${TMPDIR:-/tmp}/riser_soil-fresh.XXXXXX")
    trap clean_up EXIT
    timed "bare Debian ($suite, minbase)" make_bare_debian
    git clone --quiet "file://$root" "$fresh$inside"
    echo "verify-fresh: $(git -C "$fresh$inside" log -1 --format='commit %h, %s')"
    # All mounts live in a mount namespace of their own and vanish with it: clean_up can't reach through one of them.
    unshare --mount --pid --fork --kill-child "$0" --inside "$fresh"
    echo "verify-fresh: passed on $suite"
}

fail() {
    echo "verify-fresh: FAILED: $1" >&2
    exit 1
}

timed() { # title, command ...
    local title=$1 started=$SECONDS status=0
    shift
    echo "verify-fresh: $title ..."
    "$@" || status=$?
    [ $status -eq 0 ] || fail "$title (exit status $status, after $((SECONDS - started)) s)"
    echo "verify-fresh: $title: $((SECONDS - started)) s"
}

make_bare_debian() {
    debootstrap --variant=minbase --include=ca-certificates,git,make "$suite" "$fresh" \
        "${FRESH_MIRROR:-http://deb.debian.org/debian}" >"$fresh.log" 2>&1 || { tail -n 20 "$fresh.log"; return 1; }
    chmod 755 "$fresh" # mktemp leaves it to root alone
    copy_host_configuration
}

copy_host_configuration() {
    local path
    cp -L /etc/resolv.conf /etc/hosts "$fresh/etc/"
    cp -a /etc/apt/apt.conf.d/. "$fresh/etc/apt/apt.conf.d/"
    cp -a /etc/apt/auth.conf.d/. "$fresh/etc/apt/auth.conf.d/"
    if grep -q "VERSION_CODENAME=$suite" /etc/os-release; then # another release has other sources than this host
        rm -f "$fresh/etc/apt/sources.list"
        cp -a /etc/apt/. "$fresh/etc/apt/"
        cp -a /usr/share/keyrings/. "$fresh/usr/share/keyrings/"
    fi
    cp -a /usr/local/share/ca-certificates/. "$fresh/usr/local/share/ca-certificates/"
    chroot "$fresh" update-ca-certificates >/dev/null 2>&1
    for path in /etc/pip.conf /etc/xdg/pip; do copy "$path" "$path"; done
    copy "$HOME/.pip" /root/.pip
    copy "$config/pip" /root/.config/pip
    [ -z "${PIP_CONFIG_FILE:-}" ] || copy "$PIP_CONFIG_FILE" "$PIP_CONFIG_FILE"
}

copy() { # a file or folder of this host, where it is there, to a place inside
    [ -f "$1" ] || [ -d "$1" ] || return 0
    mkdir -p "$fresh$(dirname "$2")"
    cp -aLT "$1" "$fresh$2"
}

mount_and_run() { # the new root; runs in its own mount and process namespace
    fresh=$1
    mount -t proc proc "$fresh/proc"
    mount --rbind /sys "$fresh/sys"
    mount --rbind /dev "$fresh/dev"
    local folder
    for folder in $(pip_folders) ${FRESH_BIND:-}; do
        mkdir -p "$fresh$folder"
        mount --bind -o ro "$folder" "$fresh$folder"
    done
    local command list
    IFS=';' read -ra list <<<"$commands"
    for command in "${list[@]}"; do
        command=${command#"${command%%[! ]*}"}
        timed "$command" in_fresh bash -c "cd $inside && $command"
    done
    timed "make setup again, without a network" second_setup
}

pip_folders() { # of this host, named in pip's configuration or in a PIP_* variable; an index has its files beside "simple"
    local named
    { cat /etc/pip.conf /etc/xdg/pip/* "$HOME"/.pip/* "$config"/pip/* ${PIP_CONFIG_FILE:-} 2>/dev/null || true; env | grep '^PIP_'; } \
        | sed '/^ *[#;]/d; s/^[^=]*=//; s#file://##g; s#/simple/*\($\|[[:space:]]\)#\1#g' | tr -s ' \t' '\n' | grep '^/' | sort -u \
        | while read -r named; do [ ! -d "$named" ] || echo "$named"; done
}

in_fresh() { # runs a command in the new root with nothing of this host's environment but what pip and proxies need
    local passed
    mapfile -t passed < <(env | grep -E '^(PIP_[A-Z_]+|https?_proxy|HTTPS?_PROXY|no_proxy|NO_PROXY|WORKERS)=')
    chroot "$fresh" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin "${passed[@]}" "$@"
}

second_setup() {
    local said
    said=$(in_fresh unshare --net bash -c "cd $inside && make setup 2>&1") || { echo "$said"; return 1; }
    echo "$said"
    [ "$said" = "set-up: nothing to do" ]
}

clean_up() {
    if [ -n "${FRESH_KEEP:-}" ]; then
        echo "verify-fresh: left in $fresh"
        return
    fi
    rm -rf --one-file-system "$fresh" "$fresh.log"
}

main "$@"
