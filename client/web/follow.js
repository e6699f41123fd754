// A second viewer of one session: named in the page's address, after the #, which no server and no log sees.

const byId = (id) => document.getElementById(id);

// The view id of the session that this page follows; null: it has its own.
export const followed = new URLSearchParams(location.hash.slice(1)).get('follow');

// This very page with another fragment is another viewer.
addEventListener('hashchange', () => location.reload());

// The address of a viewer that follows. It names the server too: a load balancer must not choose another.
export function linkTo(welcome) {
    const address = new URL(location.href);
    address.searchParams.set('srv', welcome.server);
    address.hash = `follow=${welcome.view_id}`;
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
    // Not the session's own id: whoever knows that can take the session over.
    const viewId = followed ?? welcome.view_id ?? '';
    byId('session').hidden = !viewId;
    byId('session').title = viewId;
    byId('session').textContent = followed
        ? `Follows session ${viewId.slice(0, 8)}: its scene, light, glass and map are set there; camera and picture are yours.`
        : `Session ${viewId.slice(0, 8)}`;
    byId('copy-link').hidden = followed !== null || !viewId;
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
