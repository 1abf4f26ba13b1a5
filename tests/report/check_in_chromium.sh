#!/usr/bin/env bash
# Makes reports and opens them in headless Chromium, at desktop and phone width, light and dark:
# no message on the console, plots drawn, nothing wider than the page, controls that work. Usage:
# check_in_chromium.sh PROGRAM PAGE_CHECKS.js. Ends with 77, which CTest counts as skipped, where
# Chromium is absent. KINEQUAD_SCREENSHOTS, where set, is a folder for pictures of the pages.
set -euo pipefail

program=$1
checks=$2
browser=$(command -v chromium || command -v chromium-browser || true)
if [[ -z $browser ]]; then
    echo "SKIPPED: Chromium is not installed; scripts/setup --checks installs it"
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Names that would break a page which does not escape them.
input="$work/bi<b>ped & \"co\""
"$program" synth biped -o "$work/made" --triangles 2000 --frames 7 --quiet >/dev/null
mkdir "$input"
for file in "$work"/made/biped.*; do mv "$file" "$input/${file/*biped./<i>\'name\'.}"; done
"$program" run "$input" -o "$work/run" --vertices 500 --quiet >/dev/null
"$program" convert "$work/run" "$work/pose.obj" --frame 0 --quiet
"$program" compare "$input" -o "$work/compare" --vertices 500 --pictures 0,3 --quiet \
    --also "</script><script>throw 1</script>=$work/pose.obj" >/dev/null

open_page() { # name, options: leaves $work/dom and $work/log
    local profile="$work/profile-$1"
    timeout 120 "$browser" --headless --no-sandbox --disable-gpu --disable-quic --no-first-run \
        --disable-background-networking --disable-component-update --disable-sync \
        --disable-dev-shm-usage \
        --allow-file-access-from-files --enable-logging=stderr --virtual-time-budget=20000 \
        --user-data-dir="$profile" "${@:2}" >"$work/dom" 2>"$work/log"
    rm -rf "$profile"
}

failures=0
fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

for report in run compare; do
    page="$work/$report/report.html"
    grep -qE '(src|href)="(https?:)?//' "$page" && fail "$report: refers to the network"
    grep -q '<polyline' "$page" || fail "$report: no plot without the script"
    for width in 390 1280; do
        # An iframe is as narrow as it is told, a window is not.
        cat >"$work/frame-$report-$width.html" <<END
<!DOCTYPE html><meta charset="utf-8"><title>checks</title><body style="margin:0">
<iframe id="report" src="$report/report.html" style="border:0;width:${width}px;height:900px"></iframe>
<pre id="result"></pre><script src="page_checks.js"></script></body>
END
        for scheme in light dark; do
            name="$report, $width px, $scheme"
            cp "$checks" "$work/page_checks.js"
            preferred=1
            [[ $scheme == dark ]] && preferred=0
            open_page "$report-$width-$scheme" --blink-settings=preferredColorScheme=$preferred \
                --window-size=1400,1000 --dump-dom "file://$work/frame-$report-$width.html#$scheme" ||
                fail "$name: Chromium ended with an error"
            grep -o 'CONSOLE.*' "$work/log" && fail "$name: a message on the console"
            grep -o '^NOT .*' "$work/dom" && fail "$name: see above"
            grep -q '^ALL CHECKS DONE' "$work/dom" || fail "$name: the checks did not end"
            if [[ -n ${KINEQUAD_SCREENSHOTS:-} ]]; then
                mkdir -p "$KINEQUAD_SCREENSHOTS"
                sed -i 's/height:900px/height:7000px/' "$work/frame-$report-$width.html"
                : >"$work/page_checks.js"
                open_page shot --blink-settings=preferredColorScheme=$preferred --hide-scrollbars \
                    --window-size=$((width < 500 ? 500 : width)),4000 \
                    --screenshot="$KINEQUAD_SCREENSHOTS/$report-$width-$scheme.png" \
                    "file://$work/frame-$report-$width.html"
            fi
        done
    done
done
((failures == 0)) && echo "all pages pass"
exit $((failures > 0))
