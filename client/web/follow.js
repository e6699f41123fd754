// A second viewer of one session: named in the page's address, after the #, which no server and no log sees.

const byId = (id) => document.getElementById(id);

// The session that this page follows; null: it has its own.
export const followed = new URLSearchParams(location.hash.slice(1)).get('follow');

// This very page with another fragment is another viewer.
addEventListener('hashchange', () => location.reload());

// The address of a viewer that follows. It names the server too: a load balancer must not choose another.
export function linkTo(welcome) {
    const address = new URL(location.href);
    address.searchParams.set('srv', welcome.server);
    address.hash = `follow=${welcome.session}`;
    return address.href;
}

// What is set at the followed session's own viewer; camera, exposure and what is shown are this page's.
const kTheirs = ['scene', 'light-x', 'light-y', 'light-z', 'preset', 'cauchy-a', 'cauchy-b', 'wavelengths', 'mode', 'bounces', 'target-error',
    'exact-receivers', 'photon-grid', 'map-size'];

export function greyOut() {
    if (followed) for (const id of kTheirs) byId(id).disabled = true;
}

// says(text) tells how it went.
export function showSession(welcome, says) {
    const short = (followed ?? welcome.session).slice(0, 8);
    byId('session').hidden = false;
    byId('session').title = followed ?? welcome.session;
    byId('session').textContent = followed
        ? `Follows session ${short}: its scene, light, glass and map are set there; camera and picture are yours.`
        : `Session ${short}`;
    byId('copy-link').hidden = followed !== null || !welcome.caps?.includes('follow');
    for (const id of ['mode-light', 'mode-camera', 'open', 'hint']) byId(id).hidden ||= followed !== null;
    byId('copy-link').onclick = async () => {
        const link = linkTo(welcome);
        try {
            await navigator.clipboard.writeText(link);
            says('The link for a second viewer is copied.');
        } catch {
            // Not a secure page, or not allowed: then by hand.
            byId('link').value = link;
            byId('link').hidden = false;
            byId('link').select();
        }
    };
}
