# What the container runs: the site at port 8080, and JupyterLab at 8888, whose address with its token is printed.
set -eu
python3 -m http.server 8080 --directory "${SITE:-/opt/site}" >/dev/null 2>&1 &
exec jupyter lab --ip=0.0.0.0 --port=8888 --no-browser
